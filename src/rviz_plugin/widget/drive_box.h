#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <QWidget>

#include "rviz_plugin/model/held_keys.h"
#include "rviz_plugin/model/operator_controls.h"
#include "rviz_plugin/model/session_port.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSlider;

namespace endovascular_sim::rviz_plugin
{

/** Box of the panel that drives the chosen instrument: by its buttons, and by the motions of keys and sticks. A key or
 *  a stick that is held while another instrument is chosen acts again after its release. */
class DriveBox : public QWidget
{
public:
  /** @param port, keys as of SessionRow */
  DriveBox(SessionPort& port, QWidget& keys);

  /** Takes over the instruments of a state. */
  void takeOver(const SessionState& state);
  /** Shows the texts of the state. @param takes_keys true if keys drive at present */
  void showState(const PanelTexts& texts, bool takes_keys);

  std::size_t chosen() const;  ///< index of the chosen instrument
  void chooseNext(int step);   ///< chooses another instrument, after the last one the first
  /** Chooses an instrument by its name; without effect for an unknown one.
   *  @return true if another one was chosen before */
  bool choose(const std::string& instrument);
  double push() const;      ///< insertion speed that is held at present [m/s]
  int instruments() const;  ///< number of instruments

  /** Hides all controls that drive; the choice of the instrument remains. */
  void setDriving(bool drives);

  void press(Motion motion, OperatorControls::Source source);
  void release(Motion motion, OperatorControls::Source source);
  /** Press and release of a key, not those of its repetition.
   *  @param time of the event [ms]; 0: unknown */
  void pressKey(Motion motion, std::uint64_t time);
  void releaseKey(Motion motion, std::uint64_t time);
  void setStick(double push, double twist);  ///< as OperatorControls::setStick()
  void releaseAll();

  /** Changes the pressure of the chosen instrument's balloon.
   *  @param atmospheres difference; 0: deflates it by vacuum */
  void changePressure(double atmospheres);
  /** Brings the balloon of the chosen instrument to a pressure.
   *  @param target [atm]; negative: the vacuum of a deflated balloon */
  void setPressure(double target);

  int speedSetting() const;           ///< position of the speed slider, 0 to 100
  void setSpeedSetting(int setting);  ///< as speedSetting()

private:
  QPushButton* motionButton(const QString& text, const QString& name, Motion motion);
  QWidget* makeBalloonRow();
  void chooseIndex(int index);
  void sendVelocity();
  bool canDrive() const;

  SessionPort& port_;
  QWidget& key_target_;
  OperatorControls controls_;
  HeldKeys keys_held_;
  bool is_stick_held_ = false;
  bool waits_for_stick_ = false;  ///< until the stick is released: another instrument was chosen meanwhile
  bool drives_ = true;            ///< false: a recording is shown
  SessionState state_;
  QComboBox* instruments_;
  QSlider* speed_;
  std::array<QPushButton*, kMotions> motions_{};
  QLabel *speed_text_, *keys_, *pressure_, *chart_;
  QDoubleSpinBox* typed_;
  std::vector<QWidget*> inflation_;  ///< controls of the balloon
  QWidget* balloon_;
};

}  // namespace endovascular_sim::rviz_plugin
