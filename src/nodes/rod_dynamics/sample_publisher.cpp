#include "nodes/rod_dynamics/sample_publisher.h"

#include "nodes/conversions/sample_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 200;  ///< 10 s of samples: the recorder must not lose any

}  // namespace

SamplePublisher::SamplePublisher(ros::NodeHandle& node, const scene::Scene& scene)
  : scene_(scene), publisher_(node.advertise<SessionSample>(names::kSessionSample, kQueue))
{
  message_.header.frame_id = names::kPatientFrame;
}

void SamplePublisher::publishStep(const simulation::Simulation& simulation,
                                  const std::vector<simulation::WallContact>& contacts, ros::Time now)
{
  if (!sampler_.addStep(scene_, simulation, contacts) || !hasSubscriber())
    return;
  toMessage(sampler_.sample(), message_);
  message_.header.stamp = now;
  message_.step = simulation.steps() - 1;
  publisher_.publish(message_);
}

}  // namespace endovascular_sim::nodes
