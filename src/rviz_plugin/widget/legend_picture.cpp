#include "rviz_plugin/widget/legend_picture.h"

#include <QFontMetrics>
#include <QPainter>

#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

// With usual fonts [pixels]: both legends stand beside each other in the vessel view of a lesson at 1280 x 800.
constexpr int kWidth = 148, kHeight = 44;
constexpr int kRim = 4;  // from the edge of the picture, and between the legends
constexpr int kTitleTop = 2, kLineHeight = 14, kLetters = 11;
constexpr int kBarLeft = 10, kBarTop = 18, kBarWidth = kWidth - 2 * kBarLeft - 4, kBarHeight = 7;
constexpr int kTick = 3, kLabelWidth = 30;

/** Largest usual font with which a text has a width [pixels]. */
QFont fittingFont(const QString& text, int width)
{
  QFont font("DejaVu Sans");
  font.setPixelSize(kLetters);
  while (font.pixelSize() > kLetters / 2 && QFontMetrics(font).horizontalAdvance(text) > width)
    font.setPixelSize(font.pixelSize() - 1);
  return font;
}

}  // namespace

QImage legendPicture(const std::string& title, const visualization::LegendScale& scale,
                     const std::function<visualization::Colour(double)>& colour_at)
{
  const double size = fontScale();
  QImage image(static_cast<int>(size * kWidth), static_cast<int>(size * kHeight), QImage::Format_ARGB32);
  image.fill(QColor(20, 24, 30, 190));
  QPainter painter(&image);
  painter.scale(size, size);
  painter.setRenderHint(QPainter::TextAntialiasing);
  painter.setPen(Qt::white);
  const QString text = QString::fromStdString(title + " [" + scale.unit + "]");
  painter.setFont(fittingFont(text, kWidth - kBarLeft - kRim));
  painter.drawText(QRect(kBarLeft, kTitleTop, kWidth - kBarLeft, kLineHeight), Qt::AlignLeft | Qt::AlignVCenter, text);
  for (int x = 0; x < kBarWidth; ++x)
  {
    const visualization::Colour colour = colour_at(scale.full * x / (kBarWidth - 1));
    painter.fillRect(kBarLeft + x, kBarTop, 1, kBarHeight, QColor::fromRgbF(colour.red, colour.green, colour.blue));
  }
  painter.setFont(fittingFont({}, kLabelWidth));
  for (std::size_t k = 0; k < scale.ticks.size(); ++k)
  {
    const int x = kBarLeft + static_cast<int>((kBarWidth - 1) * scale.ticks[k] / scale.full);
    painter.drawLine(x, kBarTop + kBarHeight, x, kBarTop + kBarHeight + kTick);
    painter.drawText(QRect(x - kLabelWidth / 2, kBarTop + kBarHeight + kTick, kLabelWidth, kLineHeight),
                     Qt::AlignHCenter | Qt::AlignVCenter, QString::fromStdString(scale.labels[k]));
  }
  return image;
}

QPoint legendPlace(int number)
{
  return {static_cast<int>(kRim + number * (fontScale() * kWidth + kRim)), kRim};
}

QSize legendsSize()
{
  return {legendPlace(2).x(), static_cast<int>(2 * kRim + fontScale() * kHeight)};
}

}  // namespace endovascular_sim::rviz_plugin
