#pragma once

#include <optional>
#include <vector>

#include <ros/ros.h>

#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** Scripted operator of a scene as a source of commands; publishes its progress. */
class ProcedureDriver
{
public:
  /** Parameters as of procedure::Operator. @param scene scene with a procedure */
  ProcedureDriver(ros::NodeHandle& node, const scene::Scene& scene, const vessel::CentrelineTree& tree,
                  const Eigen::Vector3d& entry);

  /** Commands of the coming step, one per instrument. */
  const std::vector<simulation::HandCommand>& next(const simulation::Simulation& simulation);

private:
  void publishProgress(const simulation::Simulation& simulation);

  procedure::Operator operator_;
  ros::Publisher publisher_;
  ProcedureStep published_;  ///< last published progress
};

}  // namespace endovascular_sim::nodes
