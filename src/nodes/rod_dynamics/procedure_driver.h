#pragma once

#include <optional>
#include <string>
#include <vector>

#include <ros/ros.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** Scripted operator of a scene as a source of commands; publishes its progress and its views of the C-arm. */
class ProcedureDriver
{
public:
  /** Parameters as of procedure::Operator. @param scene scene with a procedure */
  ProcedureDriver(ros::NodeHandle& node, const scene::Scene& scene, const vessel::CentrelineTree& tree,
                  const Eigen::Vector3d& entry);

  /** Commands of the coming step, one per instrument. */
  const std::vector<simulation::HandCommand>& next(const simulation::Simulation& simulation, ros::Time now);

  /** Begins the procedure again. */
  void reset();

  /** Saves or loads the operator; all of its records are published again. */
  void archive(Archive& archive);

  /** True if the procedure is complete or has failed. */
  bool isOver() const { return operator_.progress() != procedure::Progress::kRunning; }

private:
  void publishProgress(const simulation::Simulation& simulation, ros::Time now);
  void publish(std::size_t record, const simulation::Simulation& simulation, ros::Time now);
  void publishView(ros::Time now);

  std::uint64_t last_step_;        ///< last step of the scene's duration
  procedure::Operator beginning_;  ///< operator before the first step
  procedure::Operator operator_;
  ros::Publisher publisher_;
  ros::Publisher c_arm_;      ///< valid if the procedure has views and the scene has fluoroscopy
  std::string view_;          ///< last published view
  ProcedureStep published_;   ///< last published progress
  bool is_complete_ = false;  ///< true after the publication of the last step's end
};

}  // namespace endovascular_sim::nodes
