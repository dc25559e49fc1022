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
  ProcedureDriver(ros::NodeHandle& node, const session::Scene& scene, const vessel::CentrelineTree& tree,
                  const Eigen::Vector3d& entry);

  /** Commands for the coming step, one per instrument. */
  const std::vector<session::HandCommand>& next(const session::Simulation& simulation);

private:
  void tell(const session::Simulation& simulation);

  procedure::Operator operator_;
  ros::Publisher publisher_;
  ProcedureStep told_;
};

/** One record of the message; the rest of the message is left out. */
procedure::StepRecord fromMessage(const ProcedureStep& message);

}  // namespace endovascular_sim::nodes
