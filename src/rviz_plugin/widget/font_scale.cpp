#include "rviz_plugin/widget/font_scale.h"

#include <algorithm>

#include <QApplication>
#include <QScreen>
#include <QString>

#include "rviz_plugin/picture/lesson_layout.h"

namespace endovascular_sim::rviz_plugin
{

double fontScale()
{
  const QString text = qEnvironmentVariable("ENDOVASCULAR_FONT_SCALE");
  const QScreen* screen = QApplication::primaryScreen();
  if (text == "auto")
    return screen != nullptr ? lessonFontScale(screen->geometry().height()) : 1.0;
  bool is_number = false;
  const double scale = text.toDouble(&is_number);
  return is_number ? std::clamp(scale, 0.5, 3.0) : 1.0;
}

QFont scaledFont(const QFont& font)
{
  QFont scaled = font;
  if (font.pointSizeF() > 0.0)
    scaled.setPointSizeF(fontScale() * font.pointSizeF());
  else
    scaled.setPixelSize(static_cast<int>(fontScale() * font.pixelSize()));
  return scaled;
}

}  // namespace endovascular_sim::rviz_plugin
