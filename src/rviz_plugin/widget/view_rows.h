#pragma once

#include <functional>
#include <optional>
#include <string>

#include <QString>
#include <QWidget>

class QComboBox;

namespace endovascular_sim::rviz_plugin
{

class SessionPort;

/** Row of the panel that moves the C-arm to a view. */
class CArmRow : public QWidget
{
public:
  /** @param port, keys as of SessionRow */
  CArmRow(SessionPort& port, QWidget& keys);

  /** Shows the view to which the C-arm was commanded, by whomever. A view that the user is typing remains. In a
   *  disabled row an empty view is that of the scene. */
  void showView(const std::string& view);

private:
  QComboBox* views_;
  std::optional<std::string> shown_;  ///< none before the first view
};

/** Row of the panel that chooses the view of the picture.
 *  @param keys as of SessionRow
 *  @param choose receives Overview, Tip or AlongVessel */
QWidget* makeViewRow(QWidget& keys, const std::function<void(const QString&)>& choose);

}  // namespace endovascular_sim::rviz_plugin
