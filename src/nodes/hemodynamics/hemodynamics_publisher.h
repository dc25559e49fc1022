#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/FluidPressure.h>

#include "endovascular_sim/BloodFlow.h"
#include "endovascular_sim/FlowNetwork.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/VesselCentreline.h"
#include "flow/coupling/flow_engine.h"
#include "scene/model/scene.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::nodes
{

/** Publisher of pressures and flows: those of the pressure lines and of the heart at every step of the flow, and those
 *  of the whole vessel at 20 Hz of simulated time. */
class HemodynamicsPublisher
{
public:
  /** @param scene scene with the key `flow` */
  HemodynamicsPublisher(ros::NodeHandle& node, const scene::Scene& scene);

  /** Publishes the places of cells, nodes, lines and lesions. */
  void publishNetwork(const flow::FlowEngine& engine, const vessel::CentrelineTree& centreline,
                      const std::vector<vessel::PlacedLesion>& lesions, std::uint64_t content_hash);

  /** Publishes a step.
   *  @param stamp of its request */
  void publishStep(const flow::FlowRequest& request, const flow::FlowField& field, ros::Time stamp);

private:
  double time_step_;           ///< of the flow [s]
  std::uint64_t flow_period_;  ///< steps of the flow per message of the whole vessel
  std::vector<std::string> lines_;
  ros::Publisher network_, pressure_, phase_, flow_;
  FlowNetwork network_message_;
  sensor_msgs::FluidPressure pressure_message_;
  HeartPhase phase_message_;
  BloodFlow flow_message_;
};

}  // namespace endovascular_sim::nodes
