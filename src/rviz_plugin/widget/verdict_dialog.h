#pragma once

#include <QDialog>

#include "rviz_plugin/model/session_port.h"

class QLabel;
class QTableWidget;

namespace endovascular_sim::rviz_plugin
{

/** Verdict on a lesson: the marks of the trainee against their limits and the values of the expert. It opens once for
 * each recording, and leaves the window usable. Buttons open the page of the recording, begin the lesson again, and
 * play the expert's recording. */
class VerdictDialog : public QDialog
{
  Q_OBJECT

public:
  /** @param port outlives the dialog
   *  @param keys receives the focus when the dialog is closed */
  VerdictDialog(SessionPort& port, QWidget& keys);

  /** Opens for a verdict that it has not shown yet. */
  void present(const Verdict& verdict);

private:
  void fill(const Verdict& verdict);
  void finishWith(Request request);
  void openPage() const;

  SessionPort& port_;
  QWidget& keys_;
  QLabel* text_;
  QTableWidget* marks_;
  Verdict verdict_;
};

}  // namespace endovascular_sim::rviz_plugin
