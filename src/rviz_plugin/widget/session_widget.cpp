#include "rviz_plugin/widget/session_widget.h"

#include <chrono>
#include <optional>

#include <QKeyEvent>
#include <QLabel>
#include <QVBoxLayout>

#include "rviz_plugin/model/motion_obstacle.h"
#include "rviz_plugin/widget/contrast_box.h"
#include "rviz_plugin/widget/drive_box.h"
#include "rviz_plugin/widget/expert_row.h"
#include "rviz_plugin/widget/font_scale.h"
#include "rviz_plugin/widget/motion_box.h"
#include "rviz_plugin/widget/panel_parts.h"
#include "rviz_plugin/widget/player_row.h"
#include "rviz_plugin/widget/pressure_box.h"
#include "rviz_plugin/widget/session_row.h"
#include "rviz_plugin/widget/state_box.h"
#include "rviz_plugin/widget/subject_row.h"
#include "rviz_plugin/widget/verdict_dialog.h"
#include "rviz_plugin/widget/view_rows.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kRefreshPeriod = 50;  // [ms]
constexpr int kNoticeLines = 2;     // of the notice, also without one: rows below do not move
constexpr double kErrorTime = 8.0;  // during which an error is announced [s]
constexpr int kChangeTime = 3000;   // during which another instrument is announced [ms]

// Buttons of a gamepad: A, B, Y, X.
constexpr int kButtonPause = 0, kButtonNext = 1, kButtonInflate = 3, kButtonDeflate = 2;

std::optional<Motion> motionOfKey(int key)
{
  switch (key)
  {
    case Qt::Key_Up:
      return Motion::kPush;
    case Qt::Key_Down:
      return Motion::kPull;
    case Qt::Key_Left:
      return Motion::kTwistLeft;
    case Qt::Key_Right:
      return Motion::kTwistRight;
    default:
      return std::nullopt;
  }
}

}  // namespace

SessionWidget::SessionWidget(SessionPort& port, QWidget* parent, const std::string& joystick)
  : QWidget(parent), port_(port), joystick_(joystick)
{
  setFocusPolicy(Qt::StrongFocus);
  setFont(scaledFont(font()));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->setSpacing(4);
  session_ = new SessionRow(port_, *this);
  player_ = new PlayerRow(port_, *this);
  drive_ = new DriveBox(port_, *this);
  box_ = new StateBox;
  QWidget* const views = makeViewRow(*this, [this](const QString& view) { Q_EMIT viewChosen(view); });
  c_arm_ = new CArmRow(port_, *this);
  pressure_ = new PressureBox(port_, *this);
  pressure_->hide();
  motion_ = new MotionBox(port_, *this);
  motion_->hide();
  contrast_ = new ContrastBox(port_, *this);
  contrast_->hide();
  notice_ = panelLabel("notice");
  notice_->setWordWrap(true);
  notice_->setFixedHeight(kNoticeLines * fontMetrics().lineSpacing() + 8);
  for (QWidget* part :
       {static_cast<QWidget*>(session_), static_cast<QWidget*>(player_), static_cast<QWidget*>(drive_),
        static_cast<QWidget*>(notice_), static_cast<QWidget*>(pressure_), static_cast<QWidget*>(motion_),
        static_cast<QWidget*>(contrast_), static_cast<QWidget*>(c_arm_), views, static_cast<QWidget*>(box_)})
    layout->addWidget(part);
  subject_ = new SubjectRow(port_, *this);
  layout->addWidget(subject_);
  expert_ = new ExpertRow(port_, *this);
  expert_->hide();
  layout->addWidget(expert_);
  layout->addStretch(1);
  verdict_ = new VerdictDialog(port_, *this);
  connect(&timer_, &QTimer::timeout, this, &SessionWidget::refresh);
  timer_.start(kRefreshPeriod);
  refresh();
}

SessionWidget::~SessionWidget()
{
  port_.hold({});
}

int SessionWidget::speedSetting() const
{
  return drive_->speedSetting();
}

void SessionWidget::setSpeedSetting(int setting)
{
  drive_->setSpeedSetting(setting);
}

void SessionWidget::refresh()
{
  port_.confirm();
  state_ = port_.state();
  drive_->takeOver(state_);
  showPlayer();
  followProcedure();
  followJoystick();
  const PanelTexts texts = panelTexts(state_, drive_->chosen());
  session_->showState(state_, texts);
  drive_->showState(texts, takesKeys());
  box_->showState(state_, texts);
  showPatient();
  c_arm_->showView(state_.c_arm_view);
  subject_->setVisible(!state_.player);
  subject_->showSubject(state_.subject);
  expert_->setVisible(state_.expert.has_value());
  if (state_.expert)
    expert_->showState(*state_.expert);
  showNotice();
  endLesson();
}

/** Closes the recording of a lesson whose last step is done, and shows the verdict of a closed recording. */
void SessionWidget::endLesson()
{
  const bool is_done = state_.scene.is_guided && state_.isProcedureDone();
  if (is_done && !lesson_done_ && state_.is_recording)
    port_.request(Request::kStopRecording);
  lesson_done_ = is_done;
  verdict_->present(state_.verdict);
}

void SessionWidget::followProcedure()
{
  const std::size_t step = state_.presentStep();
  if (step >= state_.scene.steps.size() || step == followed_step_)
    return;
  const bool is_first = !followed_step_;
  followed_step_ = step;
  const std::string& instrument = state_.scene.steps[step].instrument;
  if (!drive_->choose(instrument) || is_first)
    return;
  change_ = instrument;
  changed_.start();
}

void SessionWidget::showPlayer()
{
  const bool is_played = state_.player.has_value();
  if (is_played)
  {
    player_->showState(*state_.player);
    player_->showTitle(state_.scene.name, state_.subject);
  }
  session_->setVisible(!is_played);
  player_->setVisible(is_played);
  drive_->setDriving(!is_played);
  c_arm_->setEnabled(!is_played);  // the pose is that of the recording
}

void SessionWidget::showPatient()
{
  pressure_->setVisible(state_.blood.has_value());
  if (state_.blood)
    pressure_->showBlood(*state_.blood, state_.player.has_value());
  motion_->setVisible(state_.motion.has_value());
  if (state_.motion)
    motion_->showMotion(*state_.motion, state_.blood.has_value(), state_.player.has_value());
  contrast_->setVisible(state_.contrast.has_value());
  if (state_.contrast)
    contrast_->showContrast(*state_.contrast, state_.scene.syringe, state_.player.has_value());
}

void SessionWidget::showNotice()
{
  const bool is_error = state_.error_age < kErrorTime;
  const bool is_change = changed_.isValid() && changed_.elapsed() < kChangeTime;
  const std::string text = is_error        ? state_.last_error
                           : state_.player ? std::string()
                           : is_change     ? "now: " + change_ + "; a key that is held acts after its release"
                                           : motionObstacle(state_, drive_->chosen(), drive_->push());
  notice_->setText(QString::fromStdString(text));
  notice_->setStyleSheet(text.empty() ? ""
                         : is_error   ? "background: #c62f2f; color: white; padding: 2px"
                                      : "background: #ffe0a3; color: #4a3c00; padding: 2px");
}

void SessionWidget::pauseOrStart()
{
  if (state_.player)
  {
    player_->playOrPause();
    return;
  }
  const drive::ControlState* operating = state_.operatingStateOf(drive_->chosen());
  const bool is_paused = operating != nullptr && operating->state == drive::OperatingState::kPaused;
  port_.request(is_paused ? Request::kStart : Request::kPause);
}

void SessionWidget::followJoystick()
{
  const double time = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  const JoystickState& stick = joystick_.poll(time);
  for (const int button : stick.pressed)
  {
    if (button == kButtonPause)
      pauseOrStart();
    else if (button == kButtonNext)
      drive_->chooseNext(1);
    else if (button == kButtonInflate)
      drive_->changePressure(1.0);
    else if (button == kButtonDeflate)
      drive_->changePressure(0.0);
  }
  drive_->setStick(stick.push, stick.twist);
}

void SessionWidget::takeKeysOf(QWidget& other)
{
  key_source_ = &other;
  other.installEventFilter(this);
}

bool SessionWidget::takesKeys() const
{
  return hasFocus() || (key_source_ && key_source_->hasFocus());
}

bool SessionWidget::eventFilter(QObject* watched, QEvent* event)
{
  if (watched != key_source_)
    return QWidget::eventFilter(watched, event);
  if (event->type() == QEvent::KeyPress)
    return pressKey(static_cast<QKeyEvent&>(*event));
  if (event->type() == QEvent::KeyRelease)
    return releaseKey(static_cast<QKeyEvent&>(*event));
  if (event->type() == QEvent::FocusOut)
    drive_->releaseAll();
  return false;
}

bool SessionWidget::pressKey(const QKeyEvent& event)
{
  if (state_.player)
    return (event.isAutoRepeat() && event.key() == Qt::Key_Space) || player_->pressKey(event.key());
  const std::optional<Motion> motion = motionOfKey(event.key());
  const bool is_page = event.key() == Qt::Key_PageUp || event.key() == Qt::Key_PageDown;
  if (!motion && !is_page && event.key() != Qt::Key_Space)
    return false;
  if (is_page)
  {
    drive_->chooseNext(event.key() == Qt::Key_PageUp ? drive_->instruments() - 1 : 1);
    return true;
  }
  if (event.isAutoRepeat())
    return true;
  if (motion)
    drive_->pressKey(*motion, event.timestamp());
  else
    pauseOrStart();
  return true;
}

bool SessionWidget::releaseKey(const QKeyEvent& event)
{
  const std::optional<Motion> motion = motionOfKey(event.key());
  if (!motion || state_.player)
    return false;
  if (!event.isAutoRepeat())
    drive_->releaseKey(*motion, event.timestamp());
  return true;
}

void SessionWidget::keyPressEvent(QKeyEvent* event)
{
  if (!pressKey(*event))
    QWidget::keyPressEvent(event);
}

void SessionWidget::keyReleaseEvent(QKeyEvent* event)
{
  if (!releaseKey(*event))
    QWidget::keyReleaseEvent(event);
}

void SessionWidget::focusInEvent(QFocusEvent* event)
{
  QWidget::focusInEvent(event);
  refresh();
}

void SessionWidget::focusOutEvent(QFocusEvent* event)
{
  QWidget::focusOutEvent(event);
  drive_->releaseAll();
}

void SessionWidget::hideEvent(QHideEvent* event)
{
  QWidget::hideEvent(event);
  drive_->releaseAll();
}

}  // namespace endovascular_sim::rviz_plugin
