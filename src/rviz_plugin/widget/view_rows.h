#pragma once

#include <functional>

#include <QString>

class QWidget;

namespace endovascular_sim::rviz_plugin
{

class SessionPort;

/** Row of the panel that moves the C-arm to a view.
 *  @param port, keys as of SessionRow */
QWidget* makeCArmRow(SessionPort& port, QWidget& keys);

/** Row of the panel that chooses the view of the picture.
 *  @param keys as of SessionRow
 *  @param choose receives Overview, Tip or AlongVessel */
QWidget* makeViewRow(QWidget& keys, const std::function<void(const QString&)>& choose);

}  // namespace endovascular_sim::rviz_plugin
