#pragma once

#include <cstdint>
#include <string>

#include <ros/ros.h>

#include "endovascular_sim/CArm.h"
#include "nodes/conversions/procedure_conversions.h"
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
  void publish(const procedure::Operator& scripted, const ProcedureStep& message);
  void publishView(const procedure::Operator& scripted, ros::Time now);

  std::uint64_t last_step_;  ///< last step of the scene's duration
  ros::Publisher publisher_;
  ros::Publisher c_arm_;  ///< valid if the procedure has views and the scene has fluoroscopy
  std::string view_;      ///< last published view
  ProcedureMessages messages_;
  std::uint32_t begun_ = 0;  ///< of the last message
  bool is_over_ = false;     ///< true after the publication of the last step's end, or of a failure
};

}  // namespace endovascular_sim::nodes
