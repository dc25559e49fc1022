#pragma once

#include <functional>
#include <string>

#include <QImage>
#include <QPoint>
#include <QSize>

#include "visualization/colour_legend.h"

namespace endovascular_sim::rviz_plugin
{

/** Picture of a legend: a title over a bar of colours, and ticks with labels below it. Its size follows fontScale().
 *  @param colour_at colour of a value */
QImage legendPicture(const std::string& title, const visualization::LegendScale& scale,
                     const std::function<visualization::Colour(double)>& colour_at);

/** Place of a legend in the row at the lower edge: margins from the lower left corner [pixels].
 *  @param number of the legend, from the left: 0 or 1 */
QPoint legendPlace(int number);

/** Size of the row of both legends with its rim, in the lower left corner [pixels]. */
QSize legendsSize();

}  // namespace endovascular_sim::rviz_plugin
