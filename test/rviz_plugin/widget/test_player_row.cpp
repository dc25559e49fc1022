#include "rviz_plugin/widget/player_row.h"

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <QApplication>
#include <QComboBox>
#include <QHelpEvent>
#include <QLabel>
#include <QPushButton>
#include <QToolTip>
#include <QtTest/QTest>

#include "endovascular_sim/PlayerControl.h"
#include "rviz_plugin/widget/chapter_slider.h"
#include "rviz_plugin/widget/session_widget.h"
#include "test/rviz_plugin/widget/widget_test.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

using Command = PlayerControl::Request;
using Played = std::vector<std::pair<std::uint8_t, double>>;

/** Recording that is played, without ROS. */
class FakeRecording : public SessionPort
{
public:
  SessionState state() const override { return present; }
  void hold(const HandVelocity& velocity) override { is_driven = is_driven || !velocity.isZero(); }
  void confirm() override {}
  void request(Request /*request*/) override { is_driven = true; }
  void changePressure(const std::string& /*instrument*/, double /*difference*/) override { is_driven = true; }
  void moveCArm(const std::string& /*view*/) override { is_driven = true; }
  void setSubject(const std::string& /*subject*/) override {}
  void alignExpert(std::uint8_t /*alignment*/) override {}
  void setBlood(const BloodRequest& /*request*/) override { is_driven = true; }
  void setMotion(const MotionRequest& /*request*/) override { is_driven = true; }
  void inject(const ContrastRequest& /*request*/) override { is_driven = true; }
  void controlPlayer(std::uint8_t command, double value) override { played.emplace_back(command, value); }

  SessionState present;
  Played played;
  bool is_driven = false;  ///< true after a command that a recording cannot follow
};

PlayerChapter chapter(std::uint8_t kind, double time, const std::string& name)
{
  PlayerChapter result;
  result.kind = kind;
  result.time = time;
  result.name = name;
  return result;
}

class PlayerRowTest : public WidgetTest
{
protected:
  PlayerRowTest()
  {
    InstrumentSummary wire;
    wire.shape.name = "wire";
    wire.takes_commands = true;
    wire.largest_speed = 1.0;
    recording.present.scene.instruments = {wire};
    recording.present.has_wire = true;
    recording.present.wire.insertion = {0.1};
    PlayerState player;
    player.first = 1.0;
    player.last = 21.0;
    player.time = 6.0;
    player.step = 6000;
    player.rate = 1.0;
    player.chapters = {chapter(PlayerChapter::STEP, 1.0, "Access, advance wire"),
                       chapter(PlayerChapter::ERROR, 5.0, "wrong branch"),
                       chapter(PlayerChapter::MARK, 11.0, "look here")};
    recording.present.player = player;
    widget = std::make_unique<SessionWidget>(recording);
    widget->resize(300, 700);
    widget->show();
    QTest::qWait(20);
    widget->setFocus();
    widget->refresh();
  }

  template <typename Child>
  Child* child(const char* name)
  {
    auto* found = widget->findChild<Child*>(name);
    EXPECT_NE(found, nullptr) << name;
    return found;
  }

  ChapterSlider& slider() { return *static_cast<ChapterSlider*>(child<QSlider>("player_time")); }
  Played taken() { return std::exchange(recording.played, {}); }

  FakeRecording recording;
  std::unique_ptr<SessionWidget> widget;
};

TEST_F(PlayerRowTest, StandsInPlaceOfTheControlsThatDrive)
{
  EXPECT_TRUE(slider().isVisible());
  for (const char* name : {"push", "pull", "twist_left", "twist_right", "start", "reset", "record"})
    EXPECT_FALSE(child<QPushButton>(name)->isVisible()) << name;
  EXPECT_TRUE(child<QComboBox>("instruments")->isVisible());
  EXPECT_FALSE(child<QPushButton>("move_c_arm")->isEnabled());
  recording.present.player.reset();
  widget->refresh();
  EXPECT_FALSE(slider().isVisible());
  EXPECT_TRUE(child<QPushButton>("push")->isVisible());
  EXPECT_TRUE(child<QPushButton>("start")->isVisible());
}

TEST_F(PlayerRowTest, ShowsTimeStepAndChapter)
{
  EXPECT_EQ(child<QLabel>("player_text")->text(), "6.00 s of 21.0 s, step 6000");
  EXPECT_EQ(child<QComboBox>("player_chapters")->currentText(), "5.0 s  Error: wrong branch");
  EXPECT_NEAR(slider().time(), 6.0, 1e-3);
  recording.present.player->time = 1.0;
  recording.present.player->chapters.clear();
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("player_chapters")->currentText(), "1.0 s  Beginning");
  EXPECT_TRUE(taken().empty()) << "the player moves the slider, not the user";
}

TEST_F(PlayerRowTest, PlaysAndPausesByButtonAndKey)
{
  QTest::mouseClick(child<QPushButton>("player_play"), Qt::LeftButton);
  EXPECT_EQ(taken(), (Played{{Command::PLAY, 0.0}}));
  recording.present.player->playing = true;
  widget->refresh();
  QTest::keyClick(widget.get(), Qt::Key_Space);
  EXPECT_EQ(taken(), (Played{{Command::PAUSE, 0.0}}));
}

TEST_F(PlayerRowTest, HasTheKeysOfTheDocument)
{
  const std::pair<Qt::Key, std::pair<std::uint8_t, double>> keys[] = {{Qt::Key_Left, {Command::STEP, -1.0}},
                                                                      {Qt::Key_Right, {Command::STEP, 1.0}},
                                                                      {Qt::Key_PageUp, {Command::SKIP_CHAPTERS, -1.0}},
                                                                      {Qt::Key_PageDown, {Command::SKIP_CHAPTERS, 1.0}},
                                                                      {Qt::Key_Home, {Command::SEEK_TIME, 1.0}},
                                                                      {Qt::Key_End, {Command::SEEK_TIME, 21.0}},
                                                                      {Qt::Key_Up, {Command::RATE, 2.0}}};
  for (const auto& [key, command] : keys)
  {
    QTest::keyClick(widget.get(), key);
    EXPECT_EQ(taken(), Played{command}) << key;
  }
  EXPECT_FALSE(recording.is_driven);
}

TEST_F(PlayerRowTest, ChangesTheRateUpToItsLimits)
{
  for (int k = 0; k < 9; ++k)
    QTest::keyClick(widget.get(), Qt::Key_Down);
  EXPECT_EQ(recording.played.back(), Played::value_type(Command::RATE, 0.1));
  for (int k = 0; k < 9; ++k)
    QTest::keyClick(widget.get(), Qt::Key_Up);
  EXPECT_EQ(recording.played.back(), Played::value_type(Command::RATE, 10.0));
}

TEST_F(PlayerRowTest, SeeksWhereTheSliderIsClicked)
{
  QTest::mouseClick(&slider(), Qt::LeftButton, Qt::NoModifier, QPoint(slider().width() * 3 / 4, slider().height() / 2));
  const Played commands = taken();
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].first, Command::SEEK_TIME);
  EXPECT_NEAR(commands[0].second, 16.0, 0.4);
  widget->refresh();
  EXPECT_NEAR(slider().time(), 16.0, 0.4) << "it does not jump back before the player has answered";
}

TEST_F(PlayerRowTest, SeeksTheChapterWhoseTickIsClicked)
{
  const QPoint beside(slider().width() / 2 + 2, slider().height() / 2);
  QTest::mouseClick(&slider(), Qt::LeftButton, Qt::NoModifier, beside);
  EXPECT_EQ(taken(), (Played{{Command::SEEK_CHAPTER, 2.0}}));
  EXPECT_NEAR(slider().time(), 11.0, 1e-3);
}

TEST_F(PlayerRowTest, NamesTheSceneAndTheTrainee)
{
  recording.present.scene.name = "lesson_bifurcation";
  widget->refresh();
  EXPECT_EQ(child<QLabel>("player_title")->text(), "Recording of lesson_bifurcation");
  recording.present.subject = "trainee_7";
  widget->refresh();
  EXPECT_EQ(child<QLabel>("player_title")->text(), "Recording of lesson_bifurcation, trainee_7");
}

TEST_F(PlayerRowTest, SeeksTheChosenChapter)
{
  auto* chapters = child<QComboBox>("player_chapters");
  ASSERT_EQ(chapters->count(), 4);
  Q_EMIT chapters->activated(2);
  EXPECT_EQ(taken(), (Played{{Command::SEEK_CHAPTER, 1.0}}));
  Q_EMIT chapters->activated(0);
  EXPECT_EQ(taken(), (Played{{Command::SEEK_TIME, 1.0}}));
}

TEST_F(PlayerRowTest, NamesAChapterWhereTheMouseRestsOnItsTick)
{
  QHelpEvent rests(QEvent::ToolTip, QPoint(8 + (slider().width() - 16) / 2, 4), QPoint(50, 50));
  QCoreApplication::sendEvent(&slider(), &rests);
  EXPECT_EQ(QToolTip::text(), "11.0 s  Remark: look here");
}

TEST_F(PlayerRowTest, NamesWhatTheRecordingLacks)
{
  EXPECT_FALSE(child<QLabel>("player_missing")->isVisible());
  recording.present.player->missing = {"steps 5 to 9"};
  widget->refresh();
  EXPECT_EQ(child<QLabel>("player_missing")->text(), "Missing: steps 5 to 9");
  EXPECT_TRUE(child<QLabel>("player_missing")->isVisible());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
