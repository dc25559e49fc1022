#pragma once

#include <cstdint>

#include <ros/ros.h>

#include "nodes/rod_dynamics/control/pace.h"

namespace endovascular_sim::nodes
{

/** Clock of the messages of rod_dynamics: simulated time, published as /clock, or the time of ROS. */
class SimulationClock
{
public:
  /** @param parameters handle with the parameter `publish_clock`; by default true with use_sim_time in all paces but
   *         real_time
   *  @param time_step duration of a step [s] */
  SimulationClock(ros::NodeHandle& node, const ros::NodeHandle& parameters, Pace pace, double time_step);

  /** Stamp of the messages of a step.
   *  @param steps number of steps so far */
  ros::Time stamp(std::uint64_t steps) const;

  /** Publishes the time after a step at the rate of the data for display. */
  void publishStep(std::uint64_t steps);

  /** Publishes the time in any case. */
  void publish(std::uint64_t steps);

private:
  double time_step_;          ///< [s]
  std::uint64_t period_;      ///< [steps]
  ros::Publisher publisher_;  ///< invalid without simulated time
};

}  // namespace endovascular_sim::nodes
