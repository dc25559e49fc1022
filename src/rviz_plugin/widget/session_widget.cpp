#include "rviz_plugin/widget/session_widget.h"

#include <chrono>
#include <optional>

#include <QKeyEvent>
#include <QLabel>
#include <QVBoxLayout>

#include "rviz_plugin/model/motion_obstacle.h"
#include "rviz_plugin/widget/drive_box.h"
#include "rviz_plugin/widget/font_scale.h"
#include "rviz_plugin/widget/panel_parts.h"
#include "rviz_plugin/widget/session_row.h"
#include "rviz_plugin/widget/state_box.h"
#include "rviz_plugin/widget/view_rows.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kRefreshPeriod = 50;  // [ms]
constexpr int kNoticeLines = 2;     // of the notice, also without one: rows below do not move
constexpr double kErrorTime = 8.0;  // during which an error is announced [s]

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
  drive_ = new DriveBox(port_, *this);
  box_ = new StateBox;
  QWidget* const views = makeViewRow(*this, [this](const QString& view) { Q_EMIT viewChosen(view); });
  c_arm_ = new CArmRow(port_, *this);
  notice_ = panelLabel("notice");
  notice_->setWordWrap(true);
  notice_->setFixedHeight(kNoticeLines * fontMetrics().lineSpacing() + 8);
  for (QWidget* part : {static_cast<QWidget*>(session_), static_cast<QWidget*>(drive_), static_cast<QWidget*>(notice_),
                        static_cast<QWidget*>(c_arm_), views, static_cast<QWidget*>(box_)})
    layout->addWidget(part);
  layout->addStretch(1);
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
  followProcedure();
  followJoystick();
  const PanelTexts texts = panelTexts(state_, drive_->chosen());
  session_->showState(state_, texts);
  drive_->showState(texts, takesKeys());
  box_->showState(state_, texts);
  c_arm_->showView(state_.c_arm_view);
  showNotice();
}

void SessionWidget::followProcedure()
{
  const std::size_t step = state_.presentStep();
  if (step >= state_.scene.steps.size() || step == followed_step_)
    return;
  followed_step_ = step;
  drive_->choose(state_.scene.steps[step].instrument);
}

void SessionWidget::showNotice()
{
  const bool is_error = state_.error_age < kErrorTime;
  const std::string text = is_error ? state_.last_error : motionObstacle(state_, drive_->chosen(), drive_->push());
  notice_->setText(QString::fromStdString(text));
  notice_->setStyleSheet(text.empty() ? ""
                         : is_error   ? "background: #c62f2f; color: white; padding: 2px"
                                      : "background: #ffe0a3; color: #4a3c00; padding: 2px");
}

void SessionWidget::pauseOrStart()
{
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
    drive_->press(*motion, OperatorControls::Source::kKey);
  else
    pauseOrStart();
  return true;
}

bool SessionWidget::releaseKey(const QKeyEvent& event)
{
  const std::optional<Motion> motion = motionOfKey(event.key());
  if (!motion)
    return false;
  if (!event.isAutoRepeat())
    drive_->release(*motion, OperatorControls::Source::kKey);
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
