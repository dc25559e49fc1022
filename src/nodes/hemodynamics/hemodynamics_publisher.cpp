#include "nodes/hemodynamics/hemodynamics_publisher.h"

#include <algorithm>
#include <cmath>

#include "nodes/conversions/flow_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kFlowRate = 20.0;  ///< of the messages of the whole vessel [Hz]
constexpr int kQueue = 2000;        ///< 10 s of steps: the recorder must not lose any
constexpr int kFlowQueue = 200;     ///< 10 s

}  // namespace

HemodynamicsPublisher::HemodynamicsPublisher(ros::NodeHandle& node, const scene::Scene& scene)
  : time_step_(scene.flow->time_step),
    flow_period_(static_cast<std::uint64_t>(std::max(1.0, std::floor(1.0 / (kFlowRate * time_step_) + 1e-6)))),
    lines_(pressureLineFrames(scene))
{
  network_ = node.advertise<FlowNetwork>(names::kFlowNetwork, 1, true);
  pressure_ = node.advertise<sensor_msgs::FluidPressure>(
      names::kTipPressure, kQueue * static_cast<std::uint32_t>(std::max<std::size_t>(1, lines_.size())));
  phase_ = node.advertise<HeartPhase>(names::kHeartPhase, kQueue);
  flow_ = node.advertise<BloodFlow>(names::kBloodFlow, kFlowQueue);
  phase_message_.header.frame_id = flow_message_.header.frame_id = names::kPatientFrame;
}

void HemodynamicsPublisher::publishNetwork(const flow::FlowEngine& engine, const vessel::CentrelineTree& centreline,
                                           const std::vector<vessel::PlacedLesion>& lesions, std::uint64_t content_hash)
{
  network_message_ = FlowNetwork();
  network_message_.header.stamp = ros::Time::now();
  network_message_.header.frame_id = names::kPatientFrame;
  network_message_.content_hash = content_hash;
  network_message_.lines = lines_;
  toMessage(engine.body().vessel(), centreline, lesions, network_message_);
  network_.publish(network_message_);
}

void HemodynamicsPublisher::publishStep(const flow::FlowRequest& request, const flow::FlowField& field, ros::Time stamp)
{
  pressure_message_.header.stamp = phase_message_.header.stamp = flow_message_.header.stamp = stamp;
  for (std::size_t k = 0; k < lines_.size() && k < field.readings.size(); ++k)
  {
    pressure_message_.header.frame_id = lines_[k];
    pressure_message_.fluid_pressure = field.readings[k];
    pressure_.publish(pressure_message_);
  }
  phase_message_.step = flow_message_.step = request.step;
  phase_message_.time = flow_message_.time = static_cast<double>(request.step) * time_step_;
  toMessage(field, request.controls, phase_message_);
  phase_.publish(phase_message_);
  if (request.step % flow_period_ != 0)
    return;
  toMessage(field, flow_message_);
  flow_.publish(flow_message_);
}

}  // namespace endovascular_sim::nodes
