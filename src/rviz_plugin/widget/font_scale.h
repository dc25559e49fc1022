#pragma once

#include <QFont>

namespace endovascular_sim::rviz_plugin
{

/** Scale of fonts, 0.5 to 3: that of the environment variable ENDOVASCULAR_FONT_SCALE, which rviz_window sets. With
 *  "auto" it follows the height of the screen (lessonFontScale()); without it 1. */
double fontScale();

/** Font of another size: times fontScale(). */
QFont scaledFont(const QFont& font);

}  // namespace endovascular_sim::rviz_plugin
