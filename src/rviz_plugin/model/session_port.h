#pragma once

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
};

}  // namespace endovascular_sim::rviz_plugin
