#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <QSlider>
#include <QString>

#include "endovascular_sim/PlayerChapter.h"

namespace endovascular_sim::rviz_plugin
{

/** Colour of the chapters of a kind. */
QColor colourOf(const PlayerChapter& chapter);

/** Time of a chapter and its name, for a person. */
QString textOf(const PlayerChapter& chapter);

/** Slider over the time of a recording, with a tick at every chapter. A click leads to its place, or to the
 *  chapter whose tick is there; the name of a chapter appears where the mouse rests on its tick. */
class ChapterSlider : public QSlider
{
public:
  ChapterSlider();

  /** @param first, last simulated times of the recording [s] */
  void setRecording(double first, double last, const std::vector<PlayerChapter>& chapters);

  /** @param command called with the index of a chapter, when its tick is clicked */
  void setChapterCommand(std::function<void(std::size_t)> command) { chapter_command_ = std::move(command); }

  void showTime(double time);  ///< moves the handle without a signal [s]
  double time() const;         ///< at the handle [s]

protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

private:
  int placeOf(double time) const;  ///< horizontal place of a time [pixels]
  void moveTo(int place);          ///< moves the handle to a place [pixels]
  /** Index of the chapter whose tick is nearest to a place [pixels]; none without a tick near it. */
  std::optional<std::size_t> chapterAt(int place) const;

  double first_ = 0.0, last_ = 0.0;
  std::vector<PlayerChapter> chapters_;
  std::function<void(std::size_t)> chapter_command_;
};

}  // namespace endovascular_sim::rviz_plugin
