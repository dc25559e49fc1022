#include "rviz_plugin/widget/x_ray_view.h"

#include <QPainter>
#include <QPainterPath>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kLeast = 120;     // width and height [pixels]
constexpr int kRim = 8;         // between the marks and the edge of the image [pixels]
constexpr double kLarge = 1.6;  // size of the sides' letters, relative to the font

/** Draws a text with an outline, readable on any image. @param baseline left end of the text */
void drawOutlined(const QString& text, const QPointF& baseline, const QFont& font, QPainter& painter)
{
  QPainterPath path;
  path.addText(baseline, font, text);
  painter.strokePath(path, QPen(QColor(0, 0, 0, 200), 3.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.fillPath(path, QColor(255, 240, 150));
}

void drawSide(const std::string& side, const QRect& image, Qt::Alignment at, const QFont& font, QPainter& painter)
{
  const QString text = QString::fromStdString(side);
  const QFontMetrics metrics(font);
  const double x = at == Qt::AlignLeft ? image.left() + kRim : image.right() - kRim - metrics.horizontalAdvance(text);
  drawOutlined(text, {x, image.center().y() + 0.5 * metrics.capHeight()}, font, painter);
}

/** Draws the bar of the scale at the lower right. @param pixel size of a pixel of the image */
void drawScale(const XRayMarks& marks, const QRect& image, double pixel, const QFont& font, QPainter& painter)
{
  if (marks.scale.empty())
    return;
  const QString text = QString::fromStdString(marks.scale);
  const QFontMetrics metrics(font);
  const double right = image.right() - kRim, left = right - marks.bar * pixel, y = image.bottom() - kRim - 4.0;
  for (const auto& [colour, width] : {std::pair(QColor(0, 0, 0, 200), 5.0), std::pair(QColor(255, 240, 150), 2.0)})
  {
    painter.setPen(QPen(colour, width));
    painter.drawLine(QPointF(left, y), QPointF(right, y));
    painter.drawLine(QPointF(left, y - 4.0), QPointF(left, y + 4.0));
    painter.drawLine(QPointF(right, y - 4.0), QPointF(right, y + 4.0));
  }
  drawOutlined(text, {right - metrics.horizontalAdvance(text), y - 8.0}, font, painter);
}

}  // namespace

XRayView::XRayView()
{
  setMinimumSize(kLeast, kLeast);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

void XRayView::showImage(const QImage& image)
{
  image_ = image;
  update();
}

void XRayView::showMarks(const XRayMarks& marks)
{
  marks_ = marks;
}

QRect XRayView::imageRect() const
{
  QSize size = image_.isNull() ? QSize(1, 1) : image_.size();
  size.scale(this->size(), Qt::KeepAspectRatio);
  return {QPoint((width() - size.width()) / 2, (height() - size.height()) / 2), size};
}

void XRayView::paintEvent(QPaintEvent* /*event*/)
{
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  const QRect image = imageRect();
  painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
  if (image_.isNull())
  {
    painter.setPen(Qt::gray);
    painter.drawText(image, Qt::AlignCenter, "no X-ray image");
    return;
  }
  painter.drawImage(image, image_);
  QFont large = font();
  large.setPointSizeF(kLarge * large.pointSizeF());
  drawSide(marks_.left, image, Qt::AlignLeft, large, painter);
  drawSide(marks_.right, image, Qt::AlignRight, large, painter);
  const double ascent = fontMetrics().ascent();
  drawOutlined(QString::fromStdString(marks_.angle), {image.left() + kRim + 0.0, image.top() + kRim + ascent}, font(),
               painter);
  drawOutlined(QString::fromStdString("fluoroscopy " + marks_.time),
               {image.left() + kRim + 0.0, image.bottom() - kRim - 4.0}, font(), painter);
  drawScale(marks_, image, static_cast<double>(image.width()) / image_.width(), font(), painter);
}

}  // namespace endovascular_sim::rviz_plugin
