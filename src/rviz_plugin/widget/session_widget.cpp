#include "rviz_plugin/widget/session_widget.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include <QComboBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QVBoxLayout>

#include "common/units.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kStatusWidth = 160;   // [pixels]
constexpr int kRefreshPeriod = 50;  // [ms]
using units::kAtmosphere;
constexpr double kVacuum = -0.8e5;     // gauge pressure of a deflated balloon [Pa]
constexpr std::size_t kMostTexts = 3;  // of the shown errors, and of the warnings
const char* const kViews[] = {"AP",        "LAO 40", "RAO 30", "RAO 30 CAU 20", "LAO 40 CRA 20",
                              "AP CRA 30", "spider", "lateral"};

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

QString gaugeColour(int share)
{
  return share < 50 ? "#3c9d4e" : share < 80 ? "#d9a018" : "#c62f2f";
}

QStringList firstTexts(const std::vector<std::string>& texts)
{
  QStringList shown;
  for (std::size_t k = 0; k < std::min(texts.size(), kMostTexts); ++k)
    shown << QString::fromStdString(texts[k]);
  if (texts.size() > kMostTexts)
    shown << QString("and %1 more").arg(texts.size() - kMostTexts);
  return shown;
}

}  // namespace

SessionWidget::SessionWidget(SessionPort& port, QWidget* parent, const std::string& joystick)
  : QWidget(parent), port_(port), joystick_(joystick)
{
  setFocusPolicy(Qt::StrongFocus);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->setSpacing(4);
  for (QWidget* part : {sessionRow(), driveBox(), balloonRow(), cArmRow(), viewRow(), stateBox()})
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

QPushButton* SessionWidget::requestButton(const QString& text, const QString& name, Request request)
{
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setFocusPolicy(Qt::NoFocus);
  connect(button, &QPushButton::clicked, this,
          [this, request]
          {
            setFocus();
            port_.request(request);
          });
  return button;
}

QLabel* SessionWidget::label(const QString& name)
{
  auto* result = new QLabel("–");
  result->setObjectName(name);
  result->setTextFormat(Qt::PlainText);
  return result;
}

QWidget* SessionWidget::sessionRow()
{
  auto* row = new QWidget;
  auto* layout = new QGridLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  layout->addWidget(requestButton("Start", "start", Request::kStart), 0, 0);
  layout->addWidget(requestButton("Pause", "pause", Request::kPause), 0, 1);
  layout->addWidget(requestButton("Reset", "reset", Request::kReset), 0, 2);
  record_ = new QPushButton("Record");
  record_->setObjectName("record");
  record_->setFocusPolicy(Qt::NoFocus);
  connect(record_, &QPushButton::clicked, this,
          [this]
          {
            setFocus();
            // A recording holds a run from its first step: a new one begins with a reset.
            port_.request(state_.is_recording ? Request::kStopRecording : Request::kReset);
          });
  layout->addWidget(record_, 0, 3);
  labels_.status = label("status");
  labels_.recording = label("recording");
  layout->addWidget(labels_.status, 1, 0, 1, 2);
  layout->addWidget(labels_.recording, 1, 2, 1, 2);
  return row;
}

QPushButton* SessionWidget::motionButton(const QString& text, const QString& name, Motion motion)
{
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setFocusPolicy(Qt::NoFocus);
  button->setMinimumHeight(32);
  connect(button, &QPushButton::pressed, this,
          [this, motion]
          {
            setFocus();
            controls_.press(motion, OperatorControls::Source::kButton);
            sendVelocity();
          });
  connect(button, &QPushButton::released, this,
          [this, motion]
          {
            controls_.release(motion, OperatorControls::Source::kButton);
            sendVelocity();
          });
  motions_[static_cast<std::size_t>(motion)] = button;
  return button;
}

QWidget* SessionWidget::driveBox()
{
  auto* box = new QWidget;
  auto* layout = new QGridLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  instruments_ = new QComboBox;
  instruments_->setObjectName("instruments");
  instruments_->setFocusPolicy(Qt::NoFocus);
  connect(instruments_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &SessionWidget::choose);
  layout->addWidget(instruments_, 0, 0, 1, 2);
  layout->addWidget(motionButton("Push ↑", "push", Motion::kPush), 1, 0);
  layout->addWidget(motionButton("Pull ↓", "pull", Motion::kPull), 1, 1);
  layout->addWidget(motionButton("← Twist", "twist_left", Motion::kTwistLeft), 2, 0);
  layout->addWidget(motionButton("Twist →", "twist_right", Motion::kTwistRight), 2, 1);
  speed_ = new QSlider(Qt::Horizontal);
  speed_->setObjectName("speed");
  speed_->setFocusPolicy(Qt::NoFocus);
  speed_->setRange(0, 100);
  labels_.speed = label("speed_text");
  connect(speed_, &QSlider::valueChanged, this,
          [this](int value)
          {
            controls_.setSpeed(value / 100.0);
            sendVelocity();
          });
  speed_->setValue(60);
  layout->addWidget(speed_, 3, 0);
  layout->addWidget(labels_.speed, 3, 1);
  labels_.keys = label("keys");
  layout->addWidget(labels_.keys, 4, 0, 1, 2);
  return box;
}

QWidget* SessionWidget::balloonRow()
{
  balloon_ = new QWidget;
  auto* layout = new QHBoxLayout(balloon_);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  layout->addWidget(new QLabel("Balloon"));
  labels_.pressure = label("pressure");
  layout->addWidget(labels_.pressure, 1);
  const struct
  {
    const char *text, *name;
    double atmospheres;
  } steps[] = {{"+1 atm", "inflate", 1.0}, {"−1 atm", "lower", -1.0}, {"Deflate", "deflate", 0.0}};
  for (const auto& step : steps)
  {
    auto* button = new QPushButton(step.text);
    button->setObjectName(step.name);
    button->setFocusPolicy(Qt::NoFocus);
    connect(button, &QPushButton::clicked, this,
            [this, atmospheres = step.atmospheres]
            {
              setFocus();
              changePressure(atmospheres);
            });
    layout->addWidget(button);
  }
  balloon_->hide();
  return balloon_;
}

QWidget* SessionWidget::cArmRow()
{
  auto* row = new QWidget;
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  layout->addWidget(new QLabel("C-arm"));
  views_ = new QComboBox;
  views_->setObjectName("views");
  views_->setEditable(true);
  for (const char* view : kViews)
    views_->addItem(view);
  connect(views_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int /*index*/)
          {
            port_.moveCArm(views_->currentText().toStdString());
            setFocus();
          });
  layout->addWidget(views_, 1);
  auto* move = new QPushButton("Move");
  move->setObjectName("move_c_arm");
  move->setFocusPolicy(Qt::NoFocus);
  connect(move, &QPushButton::clicked, this,
          [this]
          {
            port_.moveCArm(views_->currentText().toStdString());
            setFocus();
          });
  layout->addWidget(move);
  return row;
}

QWidget* SessionWidget::viewRow()
{
  auto* row = new QWidget;
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  layout->addWidget(new QLabel("View"));
  const struct
  {
    const char *text, *view;
  } views[] = {{"Overview", "Overview"}, {"Tip", "Tip"}, {"In vessel", "AlongVessel"}};
  for (const auto& choice : views)
  {
    auto* button = new QPushButton(choice.text);
    button->setObjectName(QString("view_") + choice.view);
    button->setFocusPolicy(Qt::NoFocus);
    connect(button, &QPushButton::clicked, this,
            [this, view = QString(choice.view)]
            {
              setFocus();
              Q_EMIT viewChosen(view);
            });
    layout->addWidget(button, 1);
  }
  return row;
}

QWidget* SessionWidget::stateBox()
{
  auto* box = new QWidget;
  auto* layout = new QFormLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setVerticalSpacing(2);
  gauge_ = new QProgressBar;
  gauge_->setObjectName("gauge");
  gauge_->setRange(0, 100);
  layout->addRow(gauge_);
  const std::pair<const char*, QLabel**> rows[] = {{"Force", &labels_.force},       {"Insertion", &labels_.insertion},
                                                   {"Rotation", &labels_.rotation}, {"Torque", &labels_.torque},
                                                   {"Branch", &labels_.branch},     {"Time", &labels_.time},
                                                   {"Procedure", &labels_.step}};
  for (const auto& [text, target] : rows)
  {
    *target = label(QString(text).toLower());
    layout->addRow(text, *target);
  }
  labels_.step->setWordWrap(true);
  labels_.hint = label("hint");
  labels_.hint->setWordWrap(true);
  labels_.hint->setStyleSheet("background: #fff6d6; color: #4a3c00; padding: 4px");
  layout->addRow(labels_.hint);
  labels_.answer = label("answer");
  labels_.answer->setWordWrap(true);
  layout->addRow(labels_.answer);
  labels_.errors = label("errors");
  labels_.errors->setWordWrap(true);
  labels_.errors->setStyleSheet("color: #c62f2f");
  layout->addRow(labels_.errors);
  labels_.warnings = label("warnings");
  labels_.warnings->setWordWrap(true);
  labels_.warnings->setStyleSheet("color: #606060");
  layout->addRow(labels_.warnings);
  return box;
}

int SessionWidget::speedSetting() const
{
  return speed_->value();
}

void SessionWidget::setSpeedSetting(int setting)
{
  speed_->setValue(setting);
}

bool SessionWidget::canDrive() const
{
  const std::size_t index = chosen();
  return index < state_.scene.instruments.size() && state_.scene.instruments[index].takes_commands;
}

void SessionWidget::sendVelocity()
{
  labels_.speed->setText(QString("%1 mm/s, %2 °/s")
                             .arg(1e3 * controls_.speed(), 0, 'f', 1)
                             .arg(57.29578 * controls_.turningSpeed(), 0, 'f', 0));
  port_.hold(canDrive() ? controls_.velocity() : HandVelocity{});
}

void SessionWidget::releaseAll()
{
  controls_.releaseAll();
  port_.hold({});
}

void SessionWidget::choose(int index)
{
  const auto chosen = static_cast<std::size_t>(std::max(index, 0));
  if (chosen < state_.scene.instruments.size())
  {
    const InstrumentSummary& instrument = state_.scene.instruments[chosen];
    controls_.choose(instrument.shape.name, instrument.largest_speed, instrument.largest_turning_speed);
  }
  else
    controls_.choose({}, 0.0, 0.0);
  sendVelocity();
}

void SessionWidget::changePressure(double atmospheres)
{
  const std::size_t index = chosen();
  if (index >= state_.scene.instruments.size() || index >= state_.wire.pressure.size() || !canDrive())
    return;
  const double present = state_.wire.pressure[index];
  const double target =
      atmospheres == 0.0 ? kVacuum : std::max(std::max(present, 0.0) + atmospheres * kAtmosphere, 0.0);
  port_.changePressure(state_.scene.instruments[index].shape.name, target - present);
}

void SessionWidget::takeOverInstruments(const SessionState& state)
{
  QStringList names;
  for (const InstrumentSummary& instrument : state.scene.instruments)
    names << QString::fromStdString(instrument.shape.name);
  QStringList present;
  for (int k = 0; k < instruments_->count(); ++k)
    present << instruments_->itemText(k);
  if (names == present)
    return;
  {
    const QSignalBlocker blocker(instruments_);
    instruments_->clear();
    instruments_->addItems(names);
  }
  choose(instruments_->currentIndex());
}

void SessionWidget::refresh()
{
  port_.confirm();
  state_ = port_.state();
  takeOverInstruments(state_);
  followJoystick();
  const std::size_t index = chosen();
  const PanelTexts texts = panelTexts(state_, index);
  const std::pair<QLabel*, const std::string*> shown[] = {
      {labels_.insertion, &texts.insertion}, {labels_.rotation, &texts.rotation}, {labels_.force, &texts.force},
      {labels_.torque, &texts.torque},       {labels_.branch, &texts.branch},     {labels_.time, &texts.time},
      {labels_.step, &texts.step},           {labels_.hint, &texts.hint},         {labels_.recording, &texts.recording},
      {labels_.pressure, &texts.pressure}};
  for (const auto& [target, text] : shown)
    target->setText(QString::fromStdString(*text));
  // One line: buttons below must not move under the mouse. The reason is among the errors.
  labels_.status->setText(
      labels_.status->fontMetrics().elidedText(QString::fromStdString(texts.status), Qt::ElideRight, kStatusWidth));
  labels_.status->setToolTip(QString::fromStdString(texts.status));
  labels_.hint->setVisible(!texts.hint.empty());
  gauge_->setValue(texts.gauge);
  gauge_->setFormat(QString("%1 % of the force limit").arg(texts.gauge));
  gauge_->setStyleSheet(QString("QProgressBar::chunk { background: %1 }").arg(gaugeColour(texts.gauge)));
  record_->setText(state_.is_recording ? "Stop rec." : "Record");
  balloon_->setVisible(index < state_.scene.instruments.size() && state_.scene.instruments[index].has_balloon);
  for (QPushButton* button : motions_)
    button->setToolTip(canDrive() ? QString() : QString("the scene does not let a topic drive this instrument"));
  labels_.keys->setText(!canDrive()   ? QString("driven by the scene")
                        : takesKeys() ? QString("Keys: arrows, space")
                                      : QString("Click here for the keys"));
  QStringList answers;
  for (const std::string& service : state_.waiting)
    answers.append("waiting for " + QString::fromStdString(service));
  if (!state_.answer.empty())
    answers.append(QString::fromStdString(state_.answer));
  labels_.answer->setText(answers.join("\n"));
  QStringList errors = firstTexts(state_.errors);
  if (state_.dead_man_stops > 0)
    errors.prepend(QString("the window was too slow: motions stopped %1 times").arg(state_.dead_man_stops));
  labels_.errors->setText(errors.join("\n"));
  labels_.warnings->setText(firstTexts(state_.warnings).join("\n"));
}

std::size_t SessionWidget::chosen() const
{
  return static_cast<std::size_t>(std::max(instruments_->currentIndex(), 0));
}

void SessionWidget::pauseOrStart()
{
  const drive::ControlState* operating = state_.operatingStateOf(chosen());
  const bool is_paused = operating != nullptr && operating->state == drive::OperatingState::kPaused;
  port_.request(is_paused ? Request::kStart : Request::kPause);
}

void SessionWidget::chooseNext(int step)
{
  if (instruments_->count() > 0)
    instruments_->setCurrentIndex((std::max(instruments_->currentIndex(), 0) + step) % instruments_->count());
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
      chooseNext(1);
    else if (button == kButtonInflate)
      changePressure(1.0);
    else if (button == kButtonDeflate)
      changePressure(0.0);
  }
  const bool is_held = stick.push != 0.0 || stick.twist != 0.0;
  controls_.setStick(stick.push, stick.twist);
  if (is_held || is_stick_held_)
    sendVelocity();
  is_stick_held_ = is_held;
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
    releaseAll();
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
    chooseNext(event.key() == Qt::Key_PageUp ? instruments_->count() - 1 : 1);
    return true;
  }
  if (event.isAutoRepeat())
    return true;
  if (motion)
  {
    controls_.press(*motion, OperatorControls::Source::kKey);
    sendVelocity();
  }
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
  {
    controls_.release(*motion, OperatorControls::Source::kKey);
    sendVelocity();
  }
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
  releaseAll();
}

void SessionWidget::hideEvent(QHideEvent* event)
{
  QWidget::hideEvent(event);
  releaseAll();
}

}  // namespace endovascular_sim::rviz_plugin
