#include "rviz_plugin/widget/chapter_slider.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalBlocker>
#include <QToolTip>

#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kUnit = 1e-3;  // of the slider's value [s]
constexpr int kEdge = 8;        // between the ends of the bar and of the widget [pixels]
constexpr int kBar = 6;         // height of the bar [pixels]
constexpr int kHandle = 12;     // diameter of the handle [pixels]
constexpr int kTickWidth = 3;   // [pixels]
constexpr int kNearTick = 5;    // distance at which the mouse rests on a tick [pixels]
constexpr int kHeight = 30;     // with usual fonts [pixels]

}  // namespace

QColor colourOf(const PlayerChapter& chapter)
{
  switch (chapter.kind)
  {
    case PlayerChapter::ERROR:
      return QColor(198, 47, 47);
    case PlayerChapter::MARK:
      return QColor(217, 160, 24);
    default:
      return QColor(58, 108, 170);
  }
}

QString textOf(const PlayerChapter& chapter)
{
  const QString kind = chapter.kind == PlayerChapter::ERROR  ? "Error: "
                       : chapter.kind == PlayerChapter::MARK ? "Remark: "
                                                             : "";
  return QString("%1 s  ").arg(chapter.time, 0, 'f', 1) + kind + QString::fromStdString(chapter.name);
}

ChapterSlider::ChapterSlider()
{
  setOrientation(Qt::Horizontal);
  setFocusPolicy(Qt::NoFocus);
  setFixedHeight(static_cast<int>(std::lround(kHeight * fontScale())));
}

void ChapterSlider::setRecording(double first, double last, const std::vector<PlayerChapter>& chapters)
{
  const QSignalBlocker blocker(this);
  first_ = first;
  last_ = std::max(first, last);
  chapters_ = chapters;
  setRange(0, static_cast<int>(std::min(std::ceil((last_ - first_) / kUnit), 2e9)));
  update();
}

void ChapterSlider::showTime(double time)
{
  const QSignalBlocker blocker(this);
  setValue(static_cast<int>(std::lround(std::clamp((time - first_) / kUnit, 0.0, 2e9))));
  update();
}

double ChapterSlider::time() const
{
  return std::min(first_ + kUnit * value(), last_);
}

int ChapterSlider::placeOf(double time) const
{
  const double share = last_ > first_ ? std::clamp((time - first_) / (last_ - first_), 0.0, 1.0) : 0.0;
  return kEdge + static_cast<int>(std::lround(share * (width() - 2 * kEdge)));
}

void ChapterSlider::moveTo(int place)
{
  const double share = static_cast<double>(place - kEdge) / std::max(width() - 2 * kEdge, 1);
  setValue(static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * maximum())));
}

std::optional<std::size_t> ChapterSlider::chapterAt(int place) const
{
  std::optional<std::size_t> nearest;
  int distance = kNearTick;
  for (std::size_t k = 0; k < chapters_.size(); ++k)
    if (const int found = std::abs(placeOf(chapters_[k].time) - place); found <= distance)
    {
      nearest = k;
      distance = found;
    }
  return nearest;
}

void ChapterSlider::paintEvent(QPaintEvent* /*event*/)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const int middle = height() / 2, handle = placeOf(time());
  const QRect bar(kEdge, middle - kBar / 2, width() - 2 * kEdge, kBar);
  painter.setBrush(QColor(190, 194, 200));
  painter.drawRoundedRect(bar, kBar / 2.0, kBar / 2.0);
  painter.setBrush(QColor(120, 150, 190));
  painter.drawRoundedRect(QRect(bar.left(), bar.top(), handle - bar.left(), kBar), kBar / 2.0, kBar / 2.0);
  // Steps above the bar, errors and remarks below it: those of one time do not hide each other.
  for (const PlayerChapter& chapter : chapters_)
  {
    const bool is_step = chapter.kind == PlayerChapter::STEP;
    const int top = is_step ? 0 : middle + kBar / 2 + 1, bottom = is_step ? middle - kBar / 2 - 1 : height();
    painter.fillRect(placeOf(chapter.time) - kTickWidth / 2, top, kTickWidth, bottom - top, colourOf(chapter));
  }
  painter.setPen(QPen(QColor(60, 70, 85), 1.5));
  painter.setBrush(QColor(250, 250, 250));
  painter.drawEllipse(QPoint(handle, middle), kHandle / 2, kHandle / 2);
}

void ChapterSlider::mousePressEvent(QMouseEvent* event)
{
  if (event->button() != Qt::LeftButton)
    return;
  if (const auto chapter = chapterAt(event->x()); chapter && chapter_command_)
  {
    showTime(chapters_[*chapter].time);
    chapter_command_(*chapter);
    return;
  }
  setSliderDown(true);
  moveTo(event->x());
}

void ChapterSlider::mouseMoveEvent(QMouseEvent* event)
{
  if (isSliderDown())
    moveTo(event->x());
}

void ChapterSlider::mouseReleaseEvent(QMouseEvent* /*event*/)
{
  setSliderDown(false);
}

bool ChapterSlider::event(QEvent* event)
{
  if (event->type() != QEvent::ToolTip)
    return QSlider::event(event);
  const auto& help = static_cast<const QHelpEvent&>(*event);
  QStringList near;
  for (const PlayerChapter& chapter : chapters_)
    if (std::abs(placeOf(chapter.time) - help.x()) <= kNearTick)
      near << textOf(chapter);
  if (near.isEmpty())
    QToolTip::hideText();
  else
    QToolTip::showText(help.globalPos(), near.join("\n"), this);
  return true;
}

}  // namespace endovascular_sim::rviz_plugin
