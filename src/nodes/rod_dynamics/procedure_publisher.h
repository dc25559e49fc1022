#pragma once

#include <cstdint>
#include <string>

#include <ros/ros.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** Publisher of the progress of a scripted operator and of its views of the C-arm. */
class ProcedurePublisher
{
public:
  /** @param scene scene with a procedure */
  ProcedurePublisher(ros::NodeHandle& node, const scene::Scene& scene);

  /** Publishes what has changed before a step.
   *  @param scripted operator that has given its commands for the step
   *  @param steps number of steps before it */
  void publishChanges(const procedure::Operator& scripted, std::uint64_t steps, ros::Time now);

  /** Begins a run: all records are published again. */
  void reset();

private:
  void publish(const procedure::Operator& scripted, std::size_t record, std::uint64_t steps, ros::Time now);
  void publishView(const procedure::Operator& scripted, ros::Time now);

  std::uint64_t last_step_;  ///< last step of the scene's duration
  ros::Publisher publisher_;
  ros::Publisher c_arm_;      ///< valid if the procedure has views and the scene has fluoroscopy
  std::string view_;          ///< last published view
  ProcedureStep published_;   ///< last published progress
  bool is_complete_ = false;  ///< true after the publication of the last step's end
};

}  // namespace endovascular_sim::nodes
