#pragma once

#include <cstdint>
#include <string>

#include <QElapsedTimer>
#include <QWidget>

#include "endovascular_sim/PlayerState.h"

class QComboBox;
class QGridLayout;
class QLabel;
class QPushButton;

namespace endovascular_sim::rviz_plugin
{

class ChapterSlider;
class SessionPort;

/** Row of the panel that plays a recording: slider with the chapters, buttons, rate. It is visible while there is a
 *  player. */
class PlayerRow : public QWidget
{
public:
  /** @param port, keys as of SessionRow */
  PlayerRow(SessionPort& port, QWidget& keys);

  void showState(const PlayerState& state);

  /** @param scene name of the recorded scene
   *  @param subject pseudonym of the trainee; may be empty */
  void showTitle(const std::string& scene, const std::string& subject);

  /** Carries out the command of a key: space plays and pauses, left and right step, page up and down skip chapters, up
   *  and down change the rate, home and end lead to the first and the last state.
   *  @param key of Qt
   *  @return false for a key without a meaning */
  bool pressKey(int key);
  void playOrPause();

private:
  void addButtons(QGridLayout& layout);
  void give(std::uint8_t command, double value = 0.0);
  void seek();
  void changeRate(int step);
  void showChapters(const PlayerState& state);

  SessionPort& port_;
  QWidget& keys_;
  PlayerState state_;
  ChapterSlider* slider_;
  QPushButton *play_, *loop_;
  QComboBox *rate_, *chapters_;
  QLabel *title_, *time_, *missing_;
  QElapsedTimer moved_;  ///< since the user moved the slider
};

}  // namespace endovascular_sim::rviz_plugin
