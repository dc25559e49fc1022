#include "rviz_plugin/widget/player_row.h"

#include <algorithm>
#include <cmath>

#include <QAbstractItemView>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStyle>

#include "endovascular_sim/PlayerControl.h"
#include "rviz_plugin/model/session_port.h"
#include "rviz_plugin/widget/chapter_slider.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

using Command = PlayerControl::Request;

constexpr double kRates[] = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0};
constexpr int kSettled = 500;    // time after a motion of the slider until it follows the player again [ms]
constexpr int kListWidth = 430;  // of the list of chapters [pixels]
constexpr std::size_t kMostMissing = 3;

/** Index of the rate next to a rate. */
int nearestRate(double rate)
{
  int nearest = 0;
  for (int k = 0; k < static_cast<int>(std::size(kRates)); ++k)
    if (std::abs(std::log(kRates[k] / rate)) < std::abs(std::log(kRates[nearest] / rate)))
      nearest = k;
  return nearest;
}

bool isEqual(const std::vector<PlayerChapter>& a, const std::vector<PlayerChapter>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const PlayerChapter& x, const PlayerChapter& y)
                    { return x.kind == y.kind && x.time == y.time && x.name == y.name; });
}

}  // namespace

PlayerRow::PlayerRow(SessionPort& port, QWidget& keys) : port_(port), keys_(keys)
{
  auto* layout = compact(new QGridLayout(this));
  title_ = panelLabel("player_title");
  layout->addWidget(title_, 0, 0, 1, 6);
  addButtons(*layout);
  slider_ = new ChapterSlider;
  slider_->setObjectName("player_time");
  connect(slider_, &QSlider::valueChanged, this, [this] { seek(); });
  slider_->setChapterCommand(
      [this](std::size_t chapter)
      {
        moved_.start();
        give(Command::SEEK_CHAPTER, static_cast<double>(chapter));
      });
  layout->addWidget(slider_, 2, 0, 1, 6);
  time_ = panelLabel("player_text");
  layout->addWidget(time_, 3, 0, 1, 4);
  rate_ = new QComboBox;
  rate_->setObjectName("player_rate");
  rate_->setFocusPolicy(Qt::NoFocus);
  rate_->setToolTip("Speed relative to the recording (keys: up, down)");
  for (const double rate : kRates)
    rate_->addItem(QString("× %1").arg(rate));
  connect(rate_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int index) { give(Command::RATE, kRates[index]); });
  layout->addWidget(rate_, 3, 4, 1, 2);
  chapters_ = new QComboBox;
  chapters_->setObjectName("player_chapters");
  chapters_->setFocusPolicy(Qt::NoFocus);
  chapters_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  chapters_->view()->setMinimumWidth(kListWidth);
  connect(chapters_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int index)
          {
            if (index > 0)
              give(Command::SEEK_CHAPTER, index - 1);
            else
              give(Command::SEEK_TIME, state_.first);
          });
  layout->addWidget(chapters_, 4, 0, 1, 6);
  missing_ = panelLabel("player_missing");
  missing_->setWordWrap(true);
  missing_->setStyleSheet("background: #ffe0a3; color: #4a3c00; padding: 2px");
  layout->addWidget(missing_, 5, 0, 1, 6);
  auto* hint = panelLabel("player_keys");
  hint->setText("Keys: space, ← →, ↑ ↓, page up and down");
  layout->addWidget(hint, 6, 0, 1, 6);
  for (int column = 0; column < 6; ++column)
    layout->setColumnStretch(column, 1);
  hide();
}

void PlayerRow::addButtons(QGridLayout& layout)
{
  const struct
  {
    const char *name, *tip;
    QStyle::StandardPixmap icon;
    std::uint8_t command;
    double value;
  } buttons[] = {
      {"player_previous", "Chapter before (page up)", QStyle::SP_MediaSkipBackward, Command::SKIP_CHAPTERS, -1.0},
      {"player_back", "One state back (left)", QStyle::SP_MediaSeekBackward, Command::STEP, -1.0},
      {"player_play", "Plays and pauses (space)", QStyle::SP_MediaPlay, Command::PLAY, 0.0},
      {"player_forward", "One state forward (right)", QStyle::SP_MediaSeekForward, Command::STEP, 1.0},
      {"player_next", "Next chapter (page down)", QStyle::SP_MediaSkipForward, Command::SKIP_CHAPTERS, 1.0}};
  int column = 0;
  for (const auto& button : buttons)
  {
    const bool plays = button.command == Command::PLAY;
    QPushButton* added = panelButton("", button.name,
                                     [this, plays, command = button.command, value = button.value]
                                     {
                                       if (plays)
                                         playOrPause();
                                       else
                                         give(command, value);
                                     });
    added->setIcon(style()->standardIcon(button.icon));
    added->setToolTip(button.tip);
    added->setAutoRepeat(button.command == Command::STEP);
    if (plays)
      play_ = added;
    layout.addWidget(added, 1, column++);
  }
  loop_ = panelButton("Loop", "player_loop", [this] { give(Command::LOOP, state_.loop ? 0.0 : 1.0); });
  loop_->setCheckable(true);
  loop_->setToolTip("Begins again at the end");
  layout.addWidget(loop_, 1, column);
}

void PlayerRow::give(std::uint8_t command, double value)
{
  keys_.setFocus();
  port_.controlPlayer(command, value);
}

void PlayerRow::seek()
{
  moved_.start();
  time_->setText(QString("%1 s of %2 s").arg(slider_->time(), 0, 'f', 2).arg(state_.last, 0, 'f', 1));
  give(Command::SEEK_TIME, slider_->time());
}

void PlayerRow::changeRate(int step)
{
  const int last = static_cast<int>(std::size(kRates)) - 1;
  const double rate = kRates[std::clamp(nearestRate(state_.rate) + step, 0, last)];
  state_.rate = rate;  // a second key before the next state goes on from this one
  give(Command::RATE, rate);
}

void PlayerRow::playOrPause()
{
  give(state_.playing ? Command::PAUSE : Command::PLAY);
}

void PlayerRow::showTitle(const std::string& scene, const std::string& subject)
{
  title_->setText(QString::fromStdString("Recording of " + scene + (subject.empty() ? "" : ", " + subject)));
}

bool PlayerRow::pressKey(int key)
{
  switch (key)
  {
    case Qt::Key_Space:
      playOrPause();
      return true;
    case Qt::Key_Left:
    case Qt::Key_Right:
      give(Command::STEP, key == Qt::Key_Left ? -1.0 : 1.0);
      return true;
    case Qt::Key_PageUp:
    case Qt::Key_PageDown:
      give(Command::SKIP_CHAPTERS, key == Qt::Key_PageUp ? -1.0 : 1.0);
      return true;
    case Qt::Key_Up:
    case Qt::Key_Down:
      changeRate(key == Qt::Key_Up ? 1 : -1);
      return true;
    case Qt::Key_Home:
    case Qt::Key_End:
      give(Command::SEEK_TIME, key == Qt::Key_Home ? state_.first : state_.last);
      return true;
    default:
      return false;
  }
}

void PlayerRow::showState(const PlayerState& state)
{
  const bool is_new = state.first != state_.first || state.last != state_.last ||
                      !isEqual(state.chapters, state_.chapters) || chapters_->count() == 0;
  state_ = state;
  if (is_new)
    showChapters(state);
  play_->setIcon(style()->standardIcon(state.playing ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay));
  loop_->setChecked(state.loop);
  rate_->setCurrentIndex(nearestRate(state.rate));
  if (!slider_->isSliderDown() && (!moved_.isValid() || moved_.elapsed() > kSettled))
  {
    slider_->showTime(state.time);
    time_->setText(QString("%1 s of %2 s, step %3")
                       .arg(state.time, 0, 'f', 2)
                       .arg(state.last, 0, 'f', 1)
                       .arg(static_cast<qulonglong>(state.step)));
  }
  int present = 0;
  for (std::size_t k = 0; k < state.chapters.size() && state.chapters[k].time <= state.time; ++k)
    present = static_cast<int>(k) + 1;
  chapters_->setCurrentIndex(present);
  QStringList missing;
  for (std::size_t k = 0; k < std::min(state.missing.size(), kMostMissing); ++k)
    missing << QString::fromStdString(state.missing[k]);
  if (state.missing.size() > kMostMissing)
    missing << QString("and %1 more").arg(state.missing.size() - kMostMissing);
  missing_->setText("Missing: " + missing.join("; "));
  missing_->setVisible(!missing.isEmpty());
}

void PlayerRow::showChapters(const PlayerState& state)
{
  slider_->setRecording(state.first, state.last, state.chapters);
  const QSignalBlocker blocker(chapters_);
  chapters_->clear();
  chapters_->addItem(QString("%1 s  Beginning").arg(state.first, 0, 'f', 1));
  for (const PlayerChapter& chapter : state.chapters)
  {
    chapters_->addItem(textOf(chapter));
    chapters_->setItemData(chapters_->count() - 1, colourOf(chapter), Qt::ForegroundRole);
  }
}

}  // namespace endovascular_sim::rviz_plugin
