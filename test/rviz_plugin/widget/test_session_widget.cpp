#include "rviz_plugin/widget/session_widget.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QtTest/QTest>

#include "rviz_plugin/widget/force_gauge.h"
#include "rviz_plugin/widget/motion_box.h"
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
  void setSubject(const std::string& subject) override { subjects.push_back(subject); }
  void alignExpert(std::uint8_t alignment) override { alignments.push_back(alignment); }
  void setBlood(const BloodRequest& request) override { bloods.push_back(request); }
  void setMotion(const MotionRequest& request) override { motions.push_back(request); }
  void inject(const ContrastRequest& request) override { injections.push_back(request); }
  void controlPlayer(std::uint8_t command, double value) override { played.emplace_back(command, value); }

  HandVelocity lastHeld() const { return held.empty() ? HandVelocity{} : held.back(); }

  SessionState present;
  std::vector<HandVelocity> held;
  std::vector<Request> requests;
  std::vector<std::pair<std::string, double>> pressures;
  std::vector<std::string> views;
  std::vector<std::pair<std::uint8_t, double>> played;
  std::vector<std::string> subjects;
  std::vector<int> alignments;
  std::vector<BloodRequest> bloods;
  std::vector<MotionRequest> motions;
  std::vector<ContrastRequest> injections;
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
  session.present.scene.steps = {{"balloon", "", ""}, {"wire", "", ""}, {"balloon", "", ""}};
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
  session.present.scene.steps = {{"wire", "", ""}, {"balloon", "", ""}};
  session.present.has_step = true;
  session.present.step.step_of_procedure = 1;
  widget->refresh();
  QTest::keyPress(widget.get(), Qt::Key_Up);
  EXPECT_FALSE(session.lastHeld().isZero());
  session.present.step.step_of_procedure = 2;
  widget->refresh();
  EXPECT_TRUE(session.lastHeld().isZero());
}

/** Sends a press or a release with a time stamp [ms]. */
void sendKey(QWidget& widget, QEvent::Type type, int key, ulong time)
{
  QKeyEvent event(type, key, Qt::NoModifier);
  event.setTimestamp(time);
  QCoreApplication::sendEvent(&widget, &event);
}

TEST_F(SessionWidgetTest, AHeldKeyDoesNotDriveTheInstrumentOfTheNextStep)
{
  session.present.scene.steps = {{"wire", "", ""}, {"balloon", "", ""}};
  session.present.has_step = true;
  session.present.step.step_of_procedure = 1;
  widget->refresh();
  sendKey(*widget, QEvent::KeyPress, Qt::Key_Up, 1000);
  EXPECT_EQ(session.lastHeld().instrument, "wire");
  session.present.step.step_of_procedure = 2;
  widget->refresh();
  EXPECT_EQ(child<QLabel>("notice")->text(), "now: balloon; a key that is held acts after its release");
  for (ulong time = 2000; time < 4000; time += 40)  // repetition of the key, which a busy Qt does not recognise
  {
    sendKey(*widget, QEvent::KeyRelease, Qt::Key_Up, time);
    sendKey(*widget, QEvent::KeyPress, Qt::Key_Up, time);
    EXPECT_TRUE(session.lastHeld().isZero()) << time;
  }
  sendKey(*widget, QEvent::KeyRelease, Qt::Key_Up, 4100);
  sendKey(*widget, QEvent::KeyPress, Qt::Key_Up, 4300);
  EXPECT_EQ(session.lastHeld().instrument, "balloon");
  EXPECT_GT(session.lastHeld().insertion, 0.0);
}

TEST_F(SessionWidgetTest, TheBalloonDoesNotChangeTheSizeOfThePanel)
{
  const QSize size = widget->sizeHint(), least = widget->minimumSizeHint();
  QTest::keyClick(widget.get(), Qt::Key_PageDown);
  widget->refresh();
  QCoreApplication::processEvents();  // of the layouts
  ASSERT_TRUE(child<QPushButton>("inflate")->isVisible());
  EXPECT_EQ(widget->sizeHint(), size);
  EXPECT_EQ(widget->minimumSizeHint(), least);
  session.present.scene.instruments.pop_back();
  widget->refresh();
  QCoreApplication::processEvents();  // of the layouts
  EXPECT_EQ(widget->minimumSizeHint().width(), least.width()) << "a scene without a balloon";
  EXPECT_LT(widget->minimumSizeHint().height(), least.height());
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

TEST_F(SessionWidgetTest, ThePeakMarkLeavesTheTextOfTheGaugeReadable)
{
  auto* gauge = child<ForceGauge>("gauge");
  const auto middle = [&](double peak)
  {
    session.present.peak_force = {peak, 0.0};
    widget->refresh();
    gauge->setFormat("text");  // the same for both
    const QImage image = gauge->grab().toImage();
    return image.copy(image.width() * 70 / 100, image.height() / 3, image.width() * 25 / 100, image.height() / 3);
  };
  EXPECT_EQ(middle(2.5), middle(4.0)) << "the mark lies above and below the text";
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

/** Verdict of a lesson that is not passed. */
Verdict failedLesson()
{
  Verdict verdict;
  verdict.run = 1;
  verdict.text = "lesson not passed: errors 3, at most 0";
  verdict.page = "/results/metrics.html";
  verdict.marks = {{"time from the first motion", "s", 16.2, 60.0, 8.1, true},
                   {"errors", "", 3.0, 0.0, std::nan(""), false}};
  return verdict;
}

TEST_F(SessionWidgetTest, ShowsTheVerdictOfALessonAgainstLimitsAndExpert)
{
  auto* dialog = child<QDialog>("verdict_dialog");
  EXPECT_FALSE(dialog->isVisible());
  session.present.verdict = failedLesson();
  widget->refresh();
  EXPECT_TRUE(dialog->isVisible());
  EXPECT_EQ(child<QLabel>("verdict")->text(), "lesson not passed: errors 3, at most 0");
  const auto* marks = child<QTableWidget>("marks");
  ASSERT_EQ(marks->rowCount(), 2);
  EXPECT_EQ(marks->item(0, 1)->text(), "16.2 s");
  EXPECT_EQ(marks->item(0, 2)->text(), "60.0 s");
  EXPECT_EQ(marks->item(0, 3)->text(), "8.1 s");
  EXPECT_EQ(marks->item(1, 3)->text(), "–");
  EXPECT_NE(marks->item(0, 1)->foreground(), marks->item(1, 1)->foreground());
}

TEST_F(SessionWidgetTest, ShowsAVerdictOnceAndTheNextOneAgain)
{
  auto* dialog = child<QDialog>("verdict_dialog");
  session.present.verdict = failedLesson();
  widget->refresh();
  QTest::mouseClick(child<QPushButton>("close_verdict"), Qt::LeftButton);
  widget->refresh();
  EXPECT_FALSE(dialog->isVisible());
  session.present.verdict.run = 2;
  widget->refresh();
  EXPECT_TRUE(dialog->isVisible());
}

TEST_F(SessionWidgetTest, BeginsTheLessonAgainOrShowsTheExpertFromTheVerdict)
{
  session.present.verdict = failedLesson();
  widget->refresh();
  QTest::mouseClick(child<QPushButton>("try_again"), Qt::LeftButton);
  EXPECT_EQ(session.requests.back(), Request::kReset);
  EXPECT_FALSE(child<QDialog>("verdict_dialog")->isVisible());
  session.present.verdict.run = 2;
  widget->refresh();
  QTest::mouseClick(child<QPushButton>("show_me"), Qt::LeftButton);
  EXPECT_EQ(session.requests.back(), Request::kShowExpert);
}

TEST_F(SessionWidgetTest, ClosesTheRecordingOfALessonOnceWhenItsLastStepIsDone)
{
  session.present.scene.is_guided = true;
  session.present.is_recording = true;
  session.present.has_step = true;
  session.present.step.outcome = ProcedureStep::RUNNING;
  session.present.step.step_of_procedure = session.present.step.steps_of_procedure = 2;
  widget->refresh();
  EXPECT_TRUE(session.requests.empty());
  session.present.step.outcome = ProcedureStep::DONE;
  widget->refresh();
  widget->refresh();
  EXPECT_EQ(session.requests, std::vector<Request>{Request::kStopRecording});
}

TEST_F(SessionWidgetTest, ShowsTheExpertInAnAlignmentWithTheDistanceOfTheTips)
{
  auto* alignments = child<QComboBox>("expert_alignments");
  EXPECT_FALSE(alignments->isVisible());
  ExpertState& expert = session.present.expert.emplace();
  expert.alignment = ExpertState::PHASE;
  expert.distance = 0.0123;
  widget->refresh();
  EXPECT_TRUE(alignments->isVisible());
  EXPECT_EQ(alignments->currentIndex(), ExpertState::PHASE);
  EXPECT_EQ(child<QLabel>("tip_distance")->text(), "tips 12.3 mm apart");
  expert.distance = std::nan("");
  widget->refresh();
  EXPECT_EQ(child<QLabel>("tip_distance")->text(), "");
  Q_EMIT alignments->activated(ExpertState::INSERTION);
  EXPECT_EQ(session.alignments, std::vector<int>{ExpertState::INSERTION});
}

TEST_F(SessionWidgetTest, NamesTheTraineeAndGivesTheKeysBack)
{
  session.present.subject = "trainee 7";
  widget->refresh();
  auto* subject = child<QLineEdit>("subject");
  EXPECT_EQ(subject->text(), "trainee 7");
  subject->setFocus();
  subject->setText("trainee 8");
  widget->refresh();
  EXPECT_EQ(subject->text(), "trainee 8");  // not replaced while it is typed
  QTest::keyClick(subject, Qt::Key_Return);
  EXPECT_EQ(session.subjects, std::vector<std::string>{"trainee 8"});
  EXPECT_TRUE(widget->hasFocus());
}

TEST_F(SessionWidgetTest, ShowsPressureWhereBloodFlowsAndChangesTheCirculation)
{
  EXPECT_FALSE(child<QPushButton>("adenosine")->isVisible());
  BloodState blood;
  blood.heart_rate = 70.0 / 60.0;
  blood.mean_pressure = 12.4e3;
  blood.lines.resize(1);
  blood.lines[0].name = "catheter";
  session.present.blood = blood;
  widget->refresh();
  EXPECT_TRUE(child<QWidget>("pressure_trace")->isVisible());
  EXPECT_EQ(child<QSpinBox>("heart_rate")->value(), 70);
  EXPECT_EQ(child<QSpinBox>("mean_pressure")->value(), 93);
  QTest::mouseClick(child<QPushButton>("adenosine"), Qt::LeftButton);
  ASSERT_EQ(session.bloods.size(), 1U);
  EXPECT_EQ(session.bloods[0].hyperaemia, 1);
  EXPECT_TRUE(std::isnan(session.bloods[0].heart_rate));
  auto* rate = child<QSpinBox>("heart_rate");
  rate->setFocus();
  rate->setValue(120);
  QTest::keyClick(rate, Qt::Key_Return);
  ASSERT_EQ(session.bloods.size(), 2U);
  EXPECT_NEAR(session.bloods[1].heart_rate, 2.0, 1e-12);
  EXPECT_EQ(session.bloods[1].hyperaemia, -1);
  session.present.player.emplace();
  widget->refresh();
  EXPECT_FALSE(child<QPushButton>("adenosine")->isEnabled()) << "nobody changes a recording";
}

MotionStatus beating()
{
  MotionStatus motion;
  motion.controls = {70.0 / 60.0, 0.25, false};
  motion.heart_rate = 70.0 / 60.0;
  return motion;
}

TEST_F(SessionWidgetTest, ShowsHeartAndBreathOfAPatientThatMovesOnly)
{
  EXPECT_FALSE(child<QPushButton>("hold_breath")->isVisible());
  session.present.motion = beating();
  widget->refresh();
  EXPECT_TRUE(child<QPushButton>("hold_breath")->isVisible());
  EXPECT_EQ(child<QSpinBox>("beats")->value(), 70);
  EXPECT_EQ(child<QSpinBox>("breaths")->value(), 15);
  EXPECT_EQ(child<QLabel>("phases")->text(), "Heart and breath: diastole, breathing");
}

TEST_F(SessionWidgetTest, HoldsTheBreathAndChangesTheRates)
{
  session.present.motion = beating();
  widget->refresh();
  QTest::mouseClick(child<QPushButton>("hold_breath"), Qt::LeftButton);
  ASSERT_EQ(session.motions.size(), 1U);
  EXPECT_EQ(session.motions[0].breath_hold, 1);
  EXPECT_TRUE(std::isnan(session.motions[0].heart_rate) && std::isnan(session.motions[0].breathing_rate));
  auto* beats = child<QSpinBox>("beats");
  beats->setFocus();
  beats->setValue(90);
  QTest::keyClick(beats, Qt::Key_Return);
  ASSERT_EQ(session.motions.size(), 2U);
  EXPECT_NEAR(session.motions[1].heart_rate, 1.5, 1e-12);
  EXPECT_TRUE(std::isnan(session.motions[1].breathing_rate));
  EXPECT_EQ(session.motions[1].breath_hold, -1);
  EXPECT_TRUE(widget->hasFocus());
  auto* breaths = child<QSpinBox>("breaths");
  breaths->setFocus();
  breaths->setValue(12);
  QTest::keyClick(breaths, Qt::Key_Return);
  ASSERT_EQ(session.motions.size(), 3U);
  EXPECT_NEAR(session.motions[2].breathing_rate, 0.2, 1e-12);
}

TEST_F(SessionWidgetTest, ShowsContrastMediumWhereASceneHasItOnly)
{
  EXPECT_FALSE(child<QPushButton>("puff")->isVisible());
  session.present.contrast = ContrastStatus{0.0, 0.0, 9e-6, 3.04e-6};
  widget->refresh();
  EXPECT_TRUE(child<QPushButton>("puff")->isVisible());
  EXPECT_EQ(child<QLabel>("contrast")->text(), "Syringe 9.0 ml, used 3.0 ml");
  EXPECT_FALSE(child<QPushButton>("stop_injection")->isEnabled());
  EXPECT_EQ(child<QSpinBox>("contrast_volume")->maximum(), 12);
  EXPECT_EQ(child<QSpinBox>("contrast_rate")->maximum(), 10);
  session.present.scene.syringe = contrast::kPumpSyringe;
  widget->refresh();
  EXPECT_EQ(child<QSpinBox>("contrast_volume")->maximum(), 150);
  EXPECT_EQ(child<QSpinBox>("contrast_rate")->maximum(), 40);
}

TEST_F(SessionWidgetTest, KeepsItsWidthWithContrastMedium)
{
  const int width = widget->sizeHint().width(), least = widget->minimumSizeHint().width();
  session.present.contrast = ContrastStatus{9e-6, 100e-6, 140e-6, 260e-6};
  session.present.scene.syringe = contrast::kPumpSyringe;
  widget->refresh();
  EXPECT_EQ(widget->sizeHint().width(), width);
  EXPECT_EQ(widget->minimumSizeHint().width(), least);
}

TEST_F(SessionWidgetTest, InjectsStopsAndRefills)
{
  session.present.contrast = ContrastStatus{3e-6, 1e-6, 9e-6, 3e-6};
  widget->refresh();
  auto* volume = child<QSpinBox>("contrast_volume");
  volume->setFocus();
  volume->setValue(8);
  QTest::keyClick(volume, Qt::Key_Return);
  EXPECT_TRUE(widget->hasFocus());
  EXPECT_TRUE(session.injections.empty()) << "a number alone injects nothing";
  for (const char* name : {"puff", "inject", "stop_injection", "refill_syringe"})
    QTest::mouseClick(child<QPushButton>(name), Qt::LeftButton);
  ASSERT_EQ(session.injections.size(), 4U);
  EXPECT_DOUBLE_EQ(session.injections[0].volume, 3e-6);
  EXPECT_DOUBLE_EQ(session.injections[0].rate, 3e-6);
  EXPECT_DOUBLE_EQ(session.injections[1].volume, 8e-6);
  EXPECT_DOUBLE_EQ(session.injections[1].rate, 4e-6);
  EXPECT_EQ(session.injections[2].volume, 0.0);
  EXPECT_FALSE(session.injections[2].refill);
  EXPECT_EQ(session.injections[3].volume, 0.0);
  EXPECT_TRUE(session.injections[3].refill);
}

TEST_F(SessionWidgetTest, InjectsNothingWhileARecordingIsPlayed)
{
  session.present.contrast = ContrastStatus{3e-6, 1e-6, 9e-6, 3e-6};
  session.present.player = PlayerState();
  widget->refresh();
  for (const char* name : {"puff", "inject", "stop_injection", "refill_syringe"})
    EXPECT_FALSE(child<QPushButton>(name)->isEnabled()) << name;
}

TEST_F(SessionWidgetTest, LetsTheBreathGo)
{
  session.present.motion = beating();
  session.present.motion->controls.breath_held = true;
  session.present.motion->is_holding = true;
  widget->refresh();
  EXPECT_TRUE(child<QPushButton>("hold_breath")->isChecked());
  EXPECT_EQ(child<QLabel>("phases")->text(), "Heart and breath: diastole, breath held");
  QTest::mouseClick(child<QPushButton>("hold_breath"), Qt::LeftButton);
  ASSERT_EQ(session.motions.size(), 1U);
  EXPECT_EQ(session.motions[0].breath_hold, 0);
}

TEST_F(SessionWidgetTest, NamesThePhases)
{
  MotionStatus motion = beating();
  motion.systole = true;
  motion.controls.breath_held = true;
  EXPECT_EQ(phaseText(motion), "Heart and breath: systole, breathing out to hold");
  motion.controls.breath_held = false;
  motion.is_holding = true;
  motion.heart_rate = 0.0;
  EXPECT_EQ(phaseText(motion), "Heart and breath: arrest, breathing again");
}

TEST_F(SessionWidgetTest, LeavesTheHeartRateToTheFlowOfBlood)
{
  session.present.motion = beating();
  session.present.motion->heart_rate = 2.0;
  widget->refresh();
  EXPECT_TRUE(child<QSpinBox>("beats")->isEnabled());
  session.present.blood.emplace();
  widget->refresh();
  EXPECT_FALSE(child<QSpinBox>("beats")->isEnabled());
  EXPECT_NE(child<QSpinBox>("beats")->toolTip().indexOf("flow of blood"), -1);
  EXPECT_EQ(child<QSpinBox>("beats")->value(), 120) << "that of the present beat";
  EXPECT_TRUE(child<QSpinBox>("breaths")->isEnabled());
  session.present.player.emplace();
  widget->refresh();
  EXPECT_FALSE(child<QPushButton>("hold_breath")->isEnabled()) << "nobody changes a recording";
  EXPECT_FALSE(child<QSpinBox>("breaths")->isEnabled());
}

TEST_F(SessionWidgetTest, KeepsItsWidthWithHeartAndBreath)
{
  const int width = widget->sizeHint().width(), least = widget->minimumSizeHint().width();
  session.present.motion = beating();
  widget->refresh();
  EXPECT_EQ(widget->sizeHint().width(), width);
  EXPECT_EQ(widget->minimumSizeHint().width(), least);
  session.present.motion->controls = {5.0, 1.0, true};
  session.present.motion->systole = true;
  widget->refresh();
  EXPECT_EQ(widget->sizeHint().width(), width);
  EXPECT_EQ(widget->minimumSizeHint().width(), least);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
