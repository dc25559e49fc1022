#include <atomic>
#include <memory>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "common/error.h"
#include "contact/detector.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/support/contact_conversions.h"
#include "nodes/support/direct_callback_queue.h"
#include "nodes/support/names.h"
#include "nodes/support/real_time.h"
#include "nodes/support/scene_parameters.h"
#include "nodes/support/vessel_conversions.h"
#include "session/scene_vessel.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 4;
constexpr int kPriority = 60;

/** Answers every rod state with the wall's features near it. */
class ContactNode
{
public:
  ContactNode(ros::NodeHandle node, RealTimeGrant grant) : node_(node), grant_(std::move(grant))
  {
    const session::Scene scene = sceneFromParameters(node_);
    if (!scene.vessel)
    {
      ROS_INFO("contact: the scene %s has no vessel, so there is nothing to do", scene.name.c_str());
      return;
    }
    law_ = session::wallLaw(*scene.vessel);
    publisher_ = node_.advertise<ContactSet>(names::kContactSet, kQueue);
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    ros::NodeHandle direct(node_);
    direct.setCallbackQueue(&queue_);
    vessel_subscriber_ = direct.subscribe(names::kVesselMesh, 1, &ContactNode::receiveVessel, this, hints);
    state_subscriber_ = direct.subscribe(names::kRodState, kQueue, &ContactNode::receiveState, this, hints);
    diagnostics_.setHardwareID("none");
    diagnostics_.add("contact", this, &ContactNode::diagnose);
    timer_ =
        node_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.update(); });
  }

private:
  void receiveVessel(const VesselMeshConstPtr& message)
  {
    detector_ = std::make_unique<contact::Detector>(fromMessage(*message), law_, message->version);
    triangles_ = message->mesh.triangles.size();
    ROS_INFO("contact: vessel version %lu, %zu triangles", static_cast<unsigned long>(message->version),
             message->mesh.triangles.size());
  }

  void receiveState(const RodStateConstPtr& message)
  {
    if (!detector_ || message->radius.size() != message->nodes.size())
      return;
    fromMessage(*message, query_);
    detector_->detect(query_, set_);
    toMessage(set_, answer_);
    answer_.header.stamp = ros::Time::now();
    answer_.header.frame_id = names::kPatientFrame;
    publisher_.publish(answer_);
    ++answered_;
    features_ = set_.features.size();
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
  {
    if (triangles_ == 0)
      status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "waiting for the vessel");
    else if (!grant_.granted)
      status.summary(diagnostic_msgs::DiagnosticStatus::WARN, grant_.message);
    else
      status.summary(diagnostic_msgs::DiagnosticStatus::OK, "answering");
    status.add("scheduling", grant_.message);
    status.add("answered", answered_.load());
    status.add("features in the last set", features_.load());
    status.add("triangles", triangles_.load());
  }

  ros::NodeHandle node_;
  RealTimeGrant grant_;
  contact::WallLaw law_;
  std::unique_ptr<contact::Detector> detector_;
  contact::Query query_;
  contact::ContactSet set_;
  ContactSet answer_;
  // For /diagnostics, which another thread writes.
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<std::size_t> features_{0};
  std::atomic<std::size_t> triangles_{0};
  ros::Publisher publisher_;
  DirectCallbackQueue queue_;
  ros::Subscriber vessel_subscriber_, state_subscriber_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer timer_;
};

}  // namespace
}  // namespace endovascular_sim::nodes

int main(int argc, char** argv)
{
  using namespace endovascular_sim;  // NOLINT: a program's main file
  const nodes::RealTimeGrant grant = nodes::askForRealTime(nodes::kPriority);
  ros::init(argc, argv, "contact");
  ros::NodeHandle node;
  if (!grant.granted)
    ROS_WARN("contact: %s", grant.message.c_str());
  try
  {
    nodes::ContactNode contact(node, grant);
    ros::spin();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("contact: %s", error.what());
    return 1;
  }
  return 0;
}
