#include "rviz_plugin/widget/name_picture.h"

#include <algorithm>
#include <utility>

#include <QFontMetrics>
#include <QPainter>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kSmallestDepth = 1e-3;  // [m]
constexpr int kRim = 3;                  // between letters and the edge of their ground [pixels]
constexpr double kLine = 1.2;            // width of a leader [pixels]
constexpr double kOutline = 3.2;         // width of its outline
constexpr double kDot = 2.2;             // radius of its end
constexpr int kOpacityOfGround = 205;    // of 255

QFont fontOf(const NameStyle& style)
{
  QFont font("DejaVu Sans");
  font.setPixelSize(std::max(style.height, 4));
  font.setStretch(QFont::SemiCondensed);
  return font;
}

QColor groundOf(const NameStyle& style)
{
  const bool is_light = style.colour.lightnessF() > 0.5;
  return is_light ? QColor(20, 24, 30, kOpacityOfGround) : QColor(250, 250, 250, kOpacityOfGround);
}

/** Point of the picture: from its upper left corner, downwards. */
QPointF toPicture(const Eigen::Vector2d& place, const visualization::PictureView& view)
{
  return {0.5 * view.width + place.x(), 0.5 * view.height - place.y()};
}

void drawLeader(const visualization::PlacedName& name, const visualization::PictureView& view, const NameStyle& style,
                QPainter& painter)
{
  const Eigen::Vector2d place = view.project(name.end);
  const QPointF end = toPicture(place, view), begin = toPicture(name.boxInside(view).nearest(place), view);
  for (const auto& [colour, width] : {std::pair(groundOf(style), kOutline), std::pair(style.colour, kLine)})
  {
    painter.setPen(QPen(colour, width));
    painter.drawLine(begin, end);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colour);
    const double radius = kDot + 0.5 * (width - kLine);
    painter.drawEllipse(end, radius, radius);
  }
}

void drawName(const visualization::PlacedName& name, const visualization::PictureView& view, const NameStyle& style,
              QPainter& painter)
{
  const visualization::Rectangle box = name.boxInside(view);
  const QRectF ground(toPicture({box.low.x(), box.high.y()}, view), toPicture({box.high.x(), box.low.y()}, view));
  painter.setPen(Qt::NoPen);
  painter.setBrush(groundOf(style));
  painter.drawRoundedRect(ground, kRim, kRim);
  painter.setPen(style.colour);
  painter.drawText(ground, Qt::AlignCenter, QString::fromStdString(name.text));
}

}  // namespace

Eigen::Vector2d nameSize(const std::string& text, const NameStyle& style)
{
  const QFontMetrics metrics(fontOf(style));
  return Eigen::Vector2d(metrics.horizontalAdvance(QString::fromStdString(text)) + 2 * kRim, metrics.height());
}

QImage namePicture(const std::vector<visualization::PlacedName>& names, const visualization::PictureView& view,
                   const NameStyle& style)
{
  QImage image(static_cast<int>(view.width), static_cast<int>(view.height), QImage::Format_ARGB32);
  image.fill(Qt::transparent);
  QPainter painter(&image);
  painter.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing);
  painter.setFont(fontOf(style));
  const auto is_drawn = [&](const visualization::PlacedName& name)
  {
    return view.depth(name.end) > kSmallestDepth &&
           image.rect().contains(toPicture(view.project(name.end), view).toPoint());
  };
  for (const visualization::PlacedName& name : names)
    if (is_drawn(name))
      drawLeader(name, view, style, painter);
  for (const visualization::PlacedName& name : names)
    if (is_drawn(name))
      drawName(name, view, style, painter);
  return image;
}

}  // namespace endovascular_sim::rviz_plugin
