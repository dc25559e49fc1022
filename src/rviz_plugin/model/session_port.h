#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "rviz_plugin/model/session_state.h"
#include "rviz_plugin/model/velocity_commander.h"

namespace endovascular_sim::rviz_plugin
{

/** Request to the simulation or the recorder. */
enum class Request
{
  kStart,          ///< ends a pause
  kPause,          ///< takes no further step
  kReset,          ///< returns to the beginning of the scene; a further recording begins
  kRepeatStep,     ///< returns to the beginning of the present step of a guided procedure; a further recording begins
  kStopRecording,  ///< closes the recording and writes its report
  kShowExpert,     ///< plays the expert's recording
  kSetSubject,     ///< names the trainee, see SessionPort::setSubject()
  kSetBlood,       ///< changes the circulation, see SessionPort::setBlood()
  kSetMotion,      ///< changes heart and breath, see SessionPort::setMotion()
  kInject,         ///< injects contrast medium, see SessionPort::inject()
  kAlignExpert,    ///< shows the expert beside the trainee, see SessionPort::alignExpert()
};

/** Change of the circulation. */
struct BloodRequest
{
  double heart_rate = unchanged();     ///< [Hz]
  double mean_pressure = unchanged();  ///< [Pa]
  int hyperaemia = -1;                 ///< 0 or 1; −1: unchanged

  static double unchanged() { return std::numeric_limits<double>::quiet_NaN(); }
};

/** Change of heart and breath. */
struct MotionRequest
{
  double heart_rate = unchanged();      ///< [Hz]
  double breathing_rate = unchanged();  ///< [Hz]
  int breath_hold = -1;                 ///< 0 or 1; −1: unchanged

  static double unchanged() { return std::numeric_limits<double>::quiet_NaN(); }
};

/** Injection of contrast medium. */
struct ContrastRequest
{
  double volume = 0.0;  ///< 0: the present injection ends [m³]
  double rate = 0.0;    ///< [m³/s]
  bool refill = false;  ///< the syringe is filled before

  static constexpr double kRise = 0.3;  ///< time in which a thumb reaches the rate [s]
};

/** Connection of the panel to a session. No function blocks. */
class SessionPort
{
public:
  virtual ~SessionPort() = default;

  virtual SessionState state() const = 0;
  virtual void hold(const HandVelocity& velocity) = 0;  ///< see VelocityCommander::hold()
  virtual void confirm() = 0;                           ///< see VelocityCommander::confirm()
  virtual void request(Request request) = 0;            ///< the outcome appears in SessionState::answer
  /** Changes the pressure of an instrument's balloon.
   *  @param difference [Pa] */
  virtual void changePressure(const std::string& instrument, double difference) = 0;
  virtual void moveCArm(const std::string& view) = 0;  ///< view by name, e.g. LAO 40
  /** Controls the player of a recording, if there is one.
   *  @param command, value those of PlayerControl */
  virtual void controlPlayer(std::uint8_t command, double value) = 0;
  virtual void setSubject(const std::string& subject) = 0;  ///< pseudonym of the trainee
  /** Shows or hides the expert beside the trainee. @param alignment of ExpertState */
  virtual void alignExpert(std::uint8_t alignment) = 0;
  virtual void setBlood(const BloodRequest& request) = 0;
  virtual void setMotion(const MotionRequest& request) = 0;
  virtual void inject(const ContrastRequest& request) = 0;
};

}  // namespace endovascular_sim::rviz_plugin
