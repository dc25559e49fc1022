#include "rviz_plugin/widget/drive_box.h"

#include <algorithm>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>

#include "common/units.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kVacuum = -0.8e5;         // gauge pressure of a deflated balloon [Pa]
constexpr double kLargestPressure = 40.0;  // that can be typed [atm]

}  // namespace

DriveBox::DriveBox(SessionPort& port, QWidget& keys) : port_(port), key_target_(keys)
{
  auto* layout = compact(new QGridLayout(this));
  instruments_ = new QComboBox;
  instruments_->setObjectName("instruments");
  instruments_->setFocusPolicy(Qt::NoFocus);
  instruments_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  layout->setColumnStretch(0, 1);
  layout->setColumnStretch(1, 1);
  connect(instruments_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int index) { chooseIndex(index); });
  layout->addWidget(instruments_, 0, 0, 1, 2);
  layout->addWidget(motionButton("Push ↑", "push", Motion::kPush), 1, 0);
  layout->addWidget(motionButton("Pull ↓", "pull", Motion::kPull), 1, 1);
  layout->addWidget(motionButton("← Twist", "twist_left", Motion::kTwistLeft), 2, 0);
  layout->addWidget(motionButton("Twist →", "twist_right", Motion::kTwistRight), 2, 1);
  speed_ = new QSlider(Qt::Horizontal);
  speed_->setObjectName("speed");
  speed_->setFocusPolicy(Qt::NoFocus);
  speed_->setRange(0, 100);
  speed_text_ = panelLabel("speed_text");
  connect(speed_, &QSlider::valueChanged, this,
          [this](int value)
          {
            controls_.setSpeed(value / 100.0);
            sendVelocity();
          });
  speed_->setValue(60);
  layout->addWidget(speed_, 3, 0);
  layout->addWidget(speed_text_, 3, 1);
  keys_ = panelLabel("keys");
  layout->addWidget(keys_, 4, 0, 1, 2);
  balloon_ = makeBalloonRow();
  layout->addWidget(balloon_, 5, 0, 1, 2);
}

QPushButton* DriveBox::motionButton(const QString& text, const QString& name, Motion motion)
{
  QPushButton* button = panelButton(text, name);
  button->setMinimumHeight(32);
  connect(button, &QPushButton::pressed, this,
          [this, motion]
          {
            key_target_.setFocus();
            press(motion, OperatorControls::Source::kButton);
          });
  connect(button, &QPushButton::released, this, [this, motion] { release(motion, OperatorControls::Source::kButton); });
  motions_[static_cast<std::size_t>(motion)] = button;
  return button;
}

QWidget* DriveBox::makeBalloonRow()
{
  auto* row = new QWidget;
  auto* layout = compact(new QGridLayout(row));
  pressure_ = panelLabel("pressure");
  chart_ = panelLabel("chart");
  layout->addWidget(new QLabel("Balloon"), 0, 0);
  layout->addWidget(pressure_, 0, 1, 1, 4);
  layout->addWidget(chart_, 1, 0, 1, 5);
  typed_ = new QDoubleSpinBox;
  typed_->setObjectName("typed_pressure");
  typed_->setDecimals(1);
  typed_->setRange(0.0, kLargestPressure);
  typed_->setSuffix(" atm");
  makeNarrow(*typed_, "00.0 atm");
  const auto set = [this]
  {
    setPressure(typed_->value());
    key_target_.setFocus();
  };
  inflation_ = {typed_, panelButton("Set", "set_pressure", set)};
  layout->addWidget(typed_, 2, 0);
  layout->addWidget(inflation_.back(), 2, 1);
  const struct
  {
    const char *text, *name;
    double atmospheres;
  } steps[] = {{"+1", "inflate", 1.0}, {"−1", "lower", -1.0}, {"Deflate", "deflate", 0.0}};
  int column = 2;
  for (const auto& step : steps)
  {
    inflation_.push_back(panelButton(step.text, step.name,
                                     [this, atmospheres = step.atmospheres]
                                     {
                                       key_target_.setFocus();
                                       changePressure(atmospheres);
                                     }));
    layout->addWidget(inflation_.back(), 2, column++);
  }
  for (QWidget* part : inflation_)
    if (auto* button = qobject_cast<QPushButton*>(part))
      makeNarrow(*button);
  for (int k = 0; k < layout->columnCount(); ++k)
    layout->setColumnStretch(k, k == 0 || k == layout->columnCount() - 1 ? 3 : 2);
  row->hide();
  return row;
}

void DriveBox::showState(const PanelTexts& texts, bool takes_keys)
{
  const std::size_t index = chosen();
  balloon_->setVisible(index < state_.scene.instruments.size() && state_.scene.instruments[index].has_balloon);
  pressure_->setText(QString::fromStdString(texts.pressure));
  chart_->setText(QString::fromStdString(texts.balloon));
  for (QPushButton* button : motions_)
    button->setToolTip(canDrive() ? QString() : QString("the scene does not let a topic drive this instrument"));
  keys_->setText(!canDrive()  ? QString("driven by the scene")
                 : takes_keys ? QString("Keys: arrows, space")
                              : QString("Click here for the keys"));
}

void DriveBox::takeOver(const SessionState& state)
{
  state_ = state;
  QStringList names;
  bool has_balloon = false;
  for (const InstrumentSummary& instrument : state_.scene.instruments)
  {
    names << QString::fromStdString(instrument.shape.name);
    has_balloon = has_balloon || instrument.has_balloon;
  }
  QStringList present;
  for (int k = 0; k < instruments_->count(); ++k)
    present << instruments_->itemText(k);
  if (names == present)
    return;
  // The row of the balloon keeps its place: those below it do not move with the choice of the instrument.
  QSizePolicy policy = balloon_->sizePolicy();
  policy.setRetainSizeWhenHidden(has_balloon);
  balloon_->setSizePolicy(policy);
  {
    const QSignalBlocker blocker(instruments_);
    instruments_->clear();
    instruments_->addItems(names);
  }
  chooseIndex(instruments_->currentIndex());
}

std::size_t DriveBox::chosen() const
{
  return static_cast<std::size_t>(std::max(instruments_->currentIndex(), 0));
}

int DriveBox::instruments() const
{
  return instruments_->count();
}

void DriveBox::chooseNext(int step)
{
  if (instruments_->count() > 0)
    instruments_->setCurrentIndex((std::max(instruments_->currentIndex(), 0) + step) % instruments_->count());
}

bool DriveBox::choose(const std::string& instrument)
{
  const int index = instruments_->findText(QString::fromStdString(instrument), Qt::MatchExactly);
  if (index < 0 || index == instruments_->currentIndex())
    return false;
  instruments_->setCurrentIndex(index);
  return true;
}

void DriveBox::setDriving(bool drives)
{
  if (drives == drives_)
    return;
  drives_ = drives;
  releaseAll();
  for (QPushButton* button : motions_)
    button->setVisible(drives);
  for (QWidget* part : inflation_)
    part->setVisible(drives);
  for (QWidget* part :
       {static_cast<QWidget*>(speed_), static_cast<QWidget*>(speed_text_), static_cast<QWidget*>(keys_)})
    part->setVisible(drives);
}

double DriveBox::push() const
{
  return canDrive() ? controls_.velocity().insertion : 0.0;
}

void DriveBox::chooseIndex(int index)
{
  keys_held_.holdBack();
  waits_for_stick_ = is_stick_held_;
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

void DriveBox::press(Motion motion, OperatorControls::Source source)
{
  controls_.press(motion, source);
  sendVelocity();
}

void DriveBox::release(Motion motion, OperatorControls::Source source)
{
  controls_.release(motion, source);
  sendVelocity();
}

void DriveBox::pressKey(Motion motion, std::uint64_t time)
{
  if (keys_held_.press(motion, time))
    press(motion, OperatorControls::Source::kKey);
}

void DriveBox::releaseKey(Motion motion, std::uint64_t time)
{
  keys_held_.release(motion, time);
  release(motion, OperatorControls::Source::kKey);
}

void DriveBox::setStick(double push, double twist)
{
  const bool is_held = push != 0.0 || twist != 0.0;
  waits_for_stick_ = waits_for_stick_ && is_held;
  controls_.setStick(waits_for_stick_ ? 0.0 : push, waits_for_stick_ ? 0.0 : twist);
  if (is_held || is_stick_held_)
    sendVelocity();
  is_stick_held_ = is_held;
}

void DriveBox::releaseAll()
{
  controls_.releaseAll();
  port_.hold({});
}

void DriveBox::changePressure(double atmospheres)
{
  const std::size_t index = chosen();
  if (index >= state_.wire.pressure.size())
    return;
  const double present = std::max(state_.wire.pressure[index], 0.0) / units::kAtmosphere;
  setPressure(atmospheres == 0.0 ? -1.0 : std::max(present + atmospheres, 0.0));
}

void DriveBox::setPressure(double target)
{
  const std::size_t index = chosen();
  if (index >= state_.scene.instruments.size() || index >= state_.wire.pressure.size() || !canDrive())
    return;
  const double pressure = target < 0.0 ? kVacuum : target * units::kAtmosphere;
  port_.changePressure(state_.scene.instruments[index].shape.name, pressure - state_.wire.pressure[index]);
  state_.wire.pressure[index] = pressure;  // a second target before the next state is a difference from this one
}

int DriveBox::speedSetting() const
{
  return speed_->value();
}

void DriveBox::setSpeedSetting(int setting)
{
  speed_->setValue(setting);
}

bool DriveBox::canDrive() const
{
  const std::size_t index = chosen();
  return drives_ && index < state_.scene.instruments.size() && state_.scene.instruments[index].takes_commands;
}

void DriveBox::sendVelocity()
{
  speed_text_->setText(QString("%1 mm/s, %2 °/s")
                           .arg(1e3 * controls_.speed(), 0, 'f', 1)
                           .arg(57.29578 * controls_.turningSpeed(), 0, 'f', 0));
  port_.hold(canDrive() ? controls_.velocity() : HandVelocity{});
}

}  // namespace endovascular_sim::rviz_plugin
