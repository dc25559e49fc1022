#include "nodes/runtime/node_program.h"

#include <exception>

#include <ros/ros.h>

namespace endovascular_sim::nodes
{
namespace
{

SchedulingGrant requestScheduling(const NodeProgram& program)
{
  if (program.scheduling == NodeScheduling::kLockStep)
    return requestLockStepScheduling(program.priority);
  avoidLockStepProcessor();
  if (program.scheduling == NodeScheduling::kIdle)
    return requestIdleScheduling();
  if (program.scheduling == NodeScheduling::kRealTime)
    return requestRealTimeScheduling(program.priority);
  return {};
}

}  // namespace

int runNode(int argc, char** argv, const NodeProgram& program,
            const std::function<bool(ros::NodeHandle& node, const SchedulingGrant& grant)>& run)
{
  // Before ROS starts its threads: they inherit the scheduling.
  const SchedulingGrant grant = requestScheduling(program);
  ros::init(argc, argv, program.name);
  ros::NodeHandle node;
  if (!grant.granted)
    ROS_WARN("scheduling: %s", grant.message.c_str());
  else if (program.scheduling != NodeScheduling::kDefault)
    ROS_INFO("scheduling: %s", grant.message.c_str());
  try
  {
    return run(node, grant) ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}

}  // namespace endovascular_sim::nodes
