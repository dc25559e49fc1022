#include "nodes/rod_dynamics/control/simulation_clock.h"

#include <algorithm>
#include <cmath>

#include <rosgraph_msgs/Clock.h>

#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kRate = 60.0;  ///< of /clock [Hz of simulated time]
constexpr int kQueue = 10;

}  // namespace

SimulationClock::SimulationClock(ros::NodeHandle& node, const ros::NodeHandle& parameters, Pace pace, double time_step)
  : time_step_(time_step), period_(static_cast<std::uint64_t>(std::max(1.0, std::floor(1.0 / (kRate * time_step)))))
{
  const bool follows = pace != Pace::kRealTime && ros::Time::isSimTime();
  if (parameters.param("publish_clock", follows))
    publisher_ = node.advertise<rosgraph_msgs::Clock>(names::kClock, kQueue);
  if (publisher_ && !ros::Time::isSimTime())
    ROS_WARN("publish_clock is set, but use_sim_time is not: the other nodes follow the wall clock");
}

ros::Time SimulationClock::stamp(std::uint64_t steps) const
{
  return publisher_ ? ros::Time(static_cast<double>(steps) * time_step_) : ros::Time::now();
}

void SimulationClock::publishStep(std::uint64_t steps)
{
  if (publisher_ && steps % period_ == 0)
    publish(steps);
}

void SimulationClock::publish(std::uint64_t steps)
{
  if (!publisher_)
    return;
  rosgraph_msgs::Clock clock;
  clock.clock = stamp(steps);
  publisher_.publish(clock);
}

}  // namespace endovascular_sim::nodes
