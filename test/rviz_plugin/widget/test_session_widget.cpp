#include "rviz_plugin/widget/session_widget.h"

#include <vector>

#include <gtest/gtest.h>
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QtTest/QTest>

#include "rviz_plugin/widget/force_gauge.h"
#include "test/rviz_plugin/widget/widget_test.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** Session that records what the widget does. */
class FakeSession : public SessionPort
{
public:
  SessionState state() const override { return present; }
  void hold(const HandVelocity& velocity) override { held.push_back(velocity); }
  void confirm() override { ++confirmed; }
  void request(Request request) override { requests.push_back(request); }
  void changePressure(const std::string& instrument, double difference) override
  {
    pressures.emplace_back(instrument, difference);
  }
  void moveCArm(const std::string& view) override { views.push_back(view); }

  HandVelocity lastHeld() const { return held.empty() ? HandVelocity{} : held.back(); }

  SessionState present;
  std::vector<HandVelocity> held;
  std::vector<Request> requests;
  std::vector<std::pair<std::string, double>> pressures;
  std::vector<std::string> views;
  int confirmed = 0;
};

class SessionWidgetTest : public WidgetTest
{
protected:
  SessionWidgetTest()
  {
    InstrumentSummary wire;
    wire.shape.name = "wire";
    wire.largest_speed = 1.0;
    wire.largest_turning_speed = 60.0;
    wire.force_limit = 5.0;
    wire.takes_commands = true;
    InstrumentSummary balloon = wire;
    balloon.shape.name = "balloon";
    balloon.has_balloon = true;
    session.present.scene.instruments = {wire, balloon};
    session.present.has_wire = true;
    session.present.wire.insertion = {0.1, 0.05};
    session.present.wire.rotation = {0.0, 0.0};
    session.present.wire.hand_force = {2.5, 0.0};
    session.present.wire.hand_torque = {0.0, 0.0};
    session.present.wire.pressure = {0.0, 2.0 * 101325.0};
    widget = std::make_unique<SessionWidget>(session);
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

  FakeSession session;
  std::unique_ptr<SessionWidget> widget;
};

TEST_F(SessionWidgetTest, RepeatsAStepOfAGuidedProcedureOnly)
{
  auto* repeat = child<QPushButton>("repeat_step");
  EXPECT_FALSE(repeat->isVisible());
  session.present.scene.is_guided = true;
  widget->refresh();
  EXPECT_TRUE(repeat->isVisible());
  QTest::mouseClick(repeat, Qt::LeftButton);
  EXPECT_EQ(session.requests, std::vector<Request>{Request::kRepeatStep});
}

TEST_F(SessionWidgetTest, HoldsAVelocityWhileAButtonIsPressed)
{
  QTest::mousePress(child<QPushButton>("push"), Qt::LeftButton);
  EXPECT_EQ(session.lastHeld().instrument, "wire");
  EXPECT_GT(session.lastHeld().insertion, 0.0);
  QTest::mouseRelease(child<QPushButton>("push"), Qt::LeftButton);
  EXPECT_TRUE(session.lastHeld().isZero());
  QTest::mousePress(child<QPushButton>("twist_right"), Qt::LeftButton);
  EXPECT_GT(session.lastHeld().rotation, 0.0);
  QTest::mouseRelease(child<QPushButton>("twist_right"), Qt::LeftButton);
  EXPECT_TRUE(session.lastHeld().isZero());
}

TEST_F(SessionWidgetTest, HoldsAVelocityWhileAKeyIsPressed)
{
  QTest::keyPress(widget.get(), Qt::Key_Up);
  QTest::keyPress(widget.get(), Qt::Key_Left);
  EXPECT_GT(session.lastHeld().insertion, 0.0);
  EXPECT_LT(session.lastHeld().rotation, 0.0);
  QTest::keyRelease(widget.get(), Qt::Key_Up);
  EXPECT_EQ(session.lastHeld().insertion, 0.0);
  QTest::keyRelease(widget.get(), Qt::Key_Left);
  EXPECT_TRUE(session.lastHeld().isZero());
}

TEST_F(SessionWidgetTest, TakesTheKeysOfThePictureUntilThatLosesTheFocus)
{
  QWidget picture;
  widget->takeKeysOf(picture);
  QTest::keyPress(&picture, Qt::Key_Up);
  EXPECT_GT(session.lastHeld().insertion, 0.0);
  QTest::keyRelease(&picture, Qt::Key_Up);
  EXPECT_TRUE(session.lastHeld().isZero());
  QTest::keyPress(&picture, Qt::Key_Left);
  EXPECT_LT(session.lastHeld().rotation, 0.0);
  QFocusEvent lost(QEvent::FocusOut);
  QCoreApplication::sendEvent(&picture, &lost);
  EXPECT_TRUE(session.lastHeld().isZero());
  QKeyEvent other(QEvent::KeyPress, Qt::Key_F, Qt::NoModifier);
  EXPECT_FALSE(widget->eventFilter(&picture, &other)) << "other keys remain those of the picture";
}

TEST_F(SessionWidgetTest, ChoosesTheViewOfThePicture)
{
  std::vector<QString> views;
  QObject::connect(widget.get(), &SessionWidget::viewChosen, [&](const QString& view) { views.push_back(view); });
  for (const char* button : {"view_Overview", "view_Tip", "view_AlongVessel"})
    QTest::mouseClick(child<QPushButton>(button), Qt::LeftButton);
  EXPECT_EQ(views, (std::vector<QString>{"Overview", "Tip", "AlongVessel"}));
}

TEST_F(SessionWidgetTest, EndsAllMotionsWhenItLosesTheFocusOrIsHidden)
{
  QTest::keyPress(widget.get(), Qt::Key_Up);
  EXPECT_FALSE(session.lastHeld().isZero());
  widget->clearFocus();
  EXPECT_TRUE(session.lastHeld().isZero());
  widget->setFocus();
  QTest::keyPress(widget.get(), Qt::Key_Up);
  EXPECT_FALSE(session.lastHeld().isZero());
  widget->hide();
  EXPECT_TRUE(session.lastHeld().isZero());
}

TEST_F(SessionWidgetTest, SendsTheRequestsOfItsButtons)
{
  for (const char* name : {"start", "pause", "reset", "record"})
    QTest::mouseClick(child<QPushButton>(name), Qt::LeftButton);
  session.present.is_recording = true;
  widget->refresh();
  QTest::mouseClick(child<QPushButton>("record"), Qt::LeftButton);
  const std::vector<Request> expected{Request::kStart, Request::kPause, Request::kReset, Request::kReset,
                                      Request::kStopRecording};
  EXPECT_EQ(session.requests, expected);
}

TEST_F(SessionWidgetTest, PausesAndStartsByTheSpaceKey)
{
  QTest::keyClick(widget.get(), Qt::Key_Space);
  session.present.operating["wire"].state = drive::OperatingState::kPaused;
  widget->refresh();
  QTest::keyClick(widget.get(), Qt::Key_Space);
  const std::vector<Request> expected{Request::kPause, Request::kStart};
  EXPECT_EQ(session.requests, expected);
}

TEST_F(SessionWidgetTest, StartsAPausedSessionWhoseFirstStateHasNotArrived)
{
  session.present.has_wire = false;  // the label says that the panel waits
  session.present.operating["wire"].state = drive::OperatingState::kPaused;
  widget->refresh();
  QTest::keyClick(widget.get(), Qt::Key_Space);
  EXPECT_EQ(session.requests, std::vector<Request>{Request::kStart});
}

TEST_F(SessionWidgetTest, DrivesTheChosenInstrumentAndItsBalloon)
{
  EXPECT_TRUE(child<QPushButton>("inflate")->isHidden() || !child<QPushButton>("inflate")->isVisible());
  QTest::keyClick(widget.get(), Qt::Key_PageDown);
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("instruments")->currentText(), "balloon");
  EXPECT_EQ(child<QLabel>("pressure")->text(), "2.0 atm");
  for (const char* name : {"inflate", "lower", "deflate"})
    QTest::mouseClick(child<QPushButton>(name), Qt::LeftButton);
  ASSERT_EQ(session.pressures.size(), 3U);
  EXPECT_DOUBLE_EQ(session.pressures[0].second, 101325.0);
  EXPECT_DOUBLE_EQ(session.pressures[1].second, -101325.0);
  EXPECT_DOUBLE_EQ(session.pressures[2].second, -0.8e5 - 2.0 * 101325.0);
  session.present.wire.pressure[1] = -0.8e5;
  widget->refresh();
  QTest::mouseClick(child<QPushButton>("inflate"), Qt::LeftButton);
  EXPECT_DOUBLE_EQ(session.pressures.back().second, 101325.0 + 0.8e5);
  EXPECT_EQ(session.pressures[0].first, "balloon");
  QTest::keyPress(widget.get(), Qt::Key_Down);
  EXPECT_EQ(session.lastHeld().instrument, "balloon");
}

TEST_F(SessionWidgetTest, BringsTheBalloonToATypedPressure)
{
  QTest::keyClick(widget.get(), Qt::Key_PageDown);
  widget->refresh();
  child<QDoubleSpinBox>("typed_pressure")->setValue(12.0);
  QTest::mouseClick(child<QPushButton>("set_pressure"), Qt::LeftButton);
  ASSERT_EQ(session.pressures.size(), 1U);
  EXPECT_DOUBLE_EQ(session.pressures[0].second, 10.0 * 101325.0);
}

TEST_F(SessionWidgetTest, ChoosesTheInstrumentOfEachNewStep)
{
  session.present.scene.steps = {{"balloon", ""}, {"wire", ""}, {"balloon", ""}};
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("instruments")->currentText(), "balloon") << "before the first message";
  QTest::keyClick(widget.get(), Qt::Key_PageDown);
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("instruments")->currentText(), "wire") << "within a step the trainee chooses";
  session.present.has_step = true;
  session.present.step.step_of_procedure = 3;
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("instruments")->currentText(), "balloon");
}

TEST_F(SessionWidgetTest, EndsAMotionWhenItChoosesTheInstrumentOfAStep)
{
  session.present.scene.steps = {{"wire", ""}, {"balloon", ""}};
  session.present.has_step = true;
  session.present.step.step_of_procedure = 1;
  widget->refresh();
  QTest::keyPress(widget.get(), Qt::Key_Up);
  EXPECT_FALSE(session.lastHeld().isZero());
  session.present.step.step_of_procedure = 2;
  widget->refresh();
  EXPECT_TRUE(session.lastHeld().isZero());
}

TEST_F(SessionWidgetTest, SaysWhyAnInstrumentDoesNotMove)
{
  session.present.wire.hand_force = {5.0, 0.0};
  widget->refresh();
  EXPECT_EQ(child<QLabel>("notice")->text(), "slips at 5 N: it is held; pull back");
  session.present.wire.hand_force = {1.0, 0.0};
  widget->refresh();
  EXPECT_EQ(child<QLabel>("notice")->text(), "");
}

TEST_F(SessionWidgetTest, AnnouncesAnErrorForAWhile)
{
  session.present.last_error = "Wrong branch: left renal";
  session.present.error_age = 1.0;
  widget->refresh();
  EXPECT_EQ(child<QLabel>("notice")->text(), "Wrong branch: left renal");
  session.present.error_age = 60.0;
  widget->refresh();
  EXPECT_EQ(child<QLabel>("notice")->text(), "");
}

TEST_F(SessionWidgetTest, FollowsTheCommandedViewOfTheCArm)
{
  session.present.c_arm_view = "LAO 40";
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("views")->currentText(), "LAO 40");
  EXPECT_TRUE(session.views.empty()) << "it shows the view and commands nothing";
  child<QComboBox>("views")->setCurrentText("RAO 30");
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("views")->currentText(), "RAO 30") << "a choice that has not been sent remains";
  session.present.c_arm_view = "spider";
  widget->refresh();
  EXPECT_EQ(child<QComboBox>("views")->currentText(), "spider");
}

TEST_F(SessionWidgetTest, MarksThePeakOfTheForce)
{
  session.present.peak_force = {4.0, 0.0};
  widget->refresh();
  auto* gauge = child<ForceGauge>("gauge");
  EXPECT_EQ(gauge->value(), 50);
  EXPECT_EQ(gauge->peak(), 80);
  const QImage image = gauge->grab().toImage();
  const QColor mark(image.pixel(image.width() * 80 / 100 - 2, image.height() - 4));
  EXPECT_GT(mark.red(), mark.blue() + 60) << mark.name().toStdString();
}

TEST_F(SessionWidgetTest, KeepsItsWidthWhateverItsTextsAre)
{
  const int width = widget->sizeHint().width(), least = widget->minimumSizeHint().width();
  session.present.is_recording = true;
  session.present.errors = {std::string(300, 'x')};
  session.present.branch = std::string(200, 'y');
  session.present.answer = std::string(200, 'z');
  session.present.last_error = std::string(200, 'e');
  session.present.error_age = 0.0;
  session.present.has_step = true;
  session.present.step.phase = std::string(200, 'p');
  session.present.wire.insertion = {1e5, 0.0};
  session.present.operating["wire"] = {drive::OperatingState::kPaused, true, false, std::string(200, 'r'), 0};
  session.present.scene.instruments[0].shape.name = std::string(100, 'n');
  widget->refresh();
  EXPECT_EQ(widget->sizeHint().width(), width);
  EXPECT_EQ(widget->minimumSizeHint().width(), least);
}

TEST_F(SessionWidgetTest, DoesNotDriveAnInstrumentThatTheSceneDrives)
{
  session.present.scene.instruments[0].takes_commands = false;
  widget->refresh();
  QTest::keyPress(widget.get(), Qt::Key_Up);
  EXPECT_TRUE(session.lastHeld().isZero());
}

TEST_F(SessionWidgetTest, MovesTheCArmToAPresetView)
{
  child<QComboBox>("views")->setCurrentText("RAO 30 CAU 20");
  QTest::mouseClick(child<QPushButton>("move_c_arm"), Qt::LeftButton);
  ASSERT_EQ(session.views.size(), 1U);
  EXPECT_EQ(session.views[0], "RAO 30 CAU 20");
}

TEST_F(SessionWidgetTest, ShowsForceStateAndErrors)
{
  session.present.answer = "refused";
  session.present.waiting = {"session/stop (3 s)"};
  session.present.errors = {"contact: no vessel"};
  session.present.warnings = {"late", "slow", "paused", "full"};
  widget->refresh();
  EXPECT_EQ(child<QProgressBar>("gauge")->value(), 50);
  EXPECT_EQ(child<QLabel>("insertion")->text(), "100.0 mm");
  EXPECT_EQ(child<QLabel>("answer")->text(), "waiting for session/stop (3 s)\nrefused");
  EXPECT_EQ(child<QLabel>("errors")->text(), "contact: no vessel");
  EXPECT_EQ(child<QLabel>("warnings")->text(), "late\nslow\npaused\nand 1 more");
}

TEST_F(SessionWidgetTest, ConfirmsItsMotionsWhileItIsAlive)
{
  const int before = session.confirmed;
  QTest::qWait(300);
  EXPECT_GT(session.confirmed, before);
}

TEST_F(SessionWidgetTest, IsEmptyWithoutASession)
{
  session.present = {};
  widget->refresh();
  QTest::keyPress(widget.get(), Qt::Key_Up);
  QTest::mouseClick(child<QPushButton>("push"), Qt::LeftButton);
  EXPECT_TRUE(session.lastHeld().isZero());
  EXPECT_EQ(child<QLabel>("insertion")->text(), "–");
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
