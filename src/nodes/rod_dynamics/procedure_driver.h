#pragma once

#include <optional>
#include <vector>

#include <ros/ros.h>

#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** The scene's scripted operator at the rod node's hands; tells the graph how he gets on. */
class ProcedureDriver
{
public:
  /** @param scene with a procedure. Parameters as of procedure::Operator */
  ProcedureDriver(ros::NodeHandle& node, const scene::Scene& scene, const vessel::CentrelineTree& tree,
                  const Eigen::Vector3d& entry);

  /** Commands for the coming step, one per instrument. */
  const std::vector<simulation::HandCommand>& next(const simulation::Simulation& simulation);

private:
  void tell(const simulation::Simulation& simulation);

  procedure::Operator operator_;
  ros::Publisher publisher_;
  ProcedureStep told_;
};

}  // namespace endovascular_sim::nodes
