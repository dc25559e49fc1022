#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/AlignExpert.h"
#include "endovascular_sim/ExpertState.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "nodes/expert/expert_recording.h"
#include "nodes/visualization/motion_history.h"

namespace endovascular_sim::nodes
{

/** ROS node of the expert: publishes the recorded instruments of an expert beside those of the trainee, of a running
 *  simulation or of a played recording, and the distance of their tips. The recording may appear after the start. */
class ExpertNode
{
public:
  /** @param node reads the parameter `expert_results`, the folder of the expert's results
   *  @param parameters private ones: `alignment`, hidden, start, phase or insertion
   *  @throws InputError for an unknown alignment */
  ExpertNode(ros::NodeHandle node, const ros::NodeHandle& parameters);

private:
  void searchRecording();
  void receiveState(const RodStateVisual& state);
  void receiveStep(const ProcedureStep& step);
  void follow();
  double beginning() const;
  bool onAlign(AlignExpert::Request& request, AlignExpert::Response& response);
  bool onShow(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void align(ExpertAlignment alignment);
  void playAlone();
  void hide();
  void show(std::size_t moment);
  void publishState(double expert_time, double distance);
  std::string nameOfExpert() const;

  ros::NodeHandle node_;
  std::string folder_;  ///< of the loaded recording, or of one that was refused
  std::unique_ptr<ExpertRecording> recording_;
  ExpertAlignment alignment_, before_alone_;
  ros::SteadyTime alone_since_;
  RodStateVisual trainee_;
  MotionHistory motions_;  ///< of the trainee's patient
  bool has_trainee_ = false;
  std::uint64_t first_step_ = 0;  ///< of the trainee's run
  double time_step_ = 0.0;        ///< of the trainee's scene [s]
  std::optional<double>
      recorded_begin_;  ///< first state of the trainee's recording; empty for a running simulation [s]
  ProcedureStep step_;
  bool has_step_ = false;
  ros::Publisher visual_, treatment_, scene_, state_;
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber states_, motion_states_, steps_, runs_, infos_, players_;
  ros::ServiceServer align_, show_;
  ros::SteadyTimer search_, alone_;
};

}  // namespace endovascular_sim::nodes
