#pragma once

#include <QString>
#include <QWidget>

#include "contrast/injection/injection.h"
#include "rviz_plugin/model/contrast_monitor.h"

class QLabel;
class QPushButton;
class QSpinBox;

namespace endovascular_sim::rviz_plugin
{

class SessionPort;

/** Rows of the panel for contrast medium: what the syringe holds, and buttons that inject. */
class ContrastBox : public QWidget
{
public:
  /** @param keys takes the focus after an input */
  ContrastBox(SessionPort& port, QWidget& keys);

  /** @param syringe of the scene, which limits volume and rate
   *  @param is_played true: a recording is played, which nobody changes */
  void showContrast(const ContrastStatus& contrast, const contrast::Syringe& syringe, bool is_played);

private:
  QLabel* text_;
  QSpinBox *volume_, *rate_;
  QPushButton *puff_, *inject_, *stop_, *refill_;
};

/** Text of the box, e.g. "Syringe 9.0 ml, used 3.0 ml". */
QString contrastText(const ContrastStatus& contrast);

}  // namespace endovascular_sim::rviz_plugin
