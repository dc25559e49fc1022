#include <atomic>
#include <deque>
#include <memory>
#include <mutex>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "common/error.h"
#include "contact/detector.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/contact_set_serializer.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kQueue = 4;
constexpr int kMovedQueue = 1000;  // none may be lost
constexpr int kPriority = 60;

/** Answers every rod state with the wall's features near it. */
class ContactNode
{
public:
  ContactNode(ros::NodeHandle node, RealTimeGrant grant) : node_(node), grant_(std::move(grant))
  {
    const scene::Scene scene = sceneFromParameters(node_);
    if (!scene.vessel)
    {
      ROS_INFO("contact: the scene %s has no vessel, so there is nothing to do", scene.name.c_str());
      return;
    }
    law_ = scene::wallLaw(*scene.vessel);
    publisher_ = node_.advertise<StampedContactSet>(names::kContactSet, kQueue);
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    ros::NodeHandle direct(node_);
    direct.setCallbackQueue(&queue_);
    vessel_subscriber_ = node_.subscribe(names::kVesselMesh, 1, &ContactNode::receiveVessel, this, hints);
    moved_subscriber_ =
        direct.subscribe(names::kWallDisplacement, kMovedQueue, &ContactNode::receiveMoved, this, hints);
    state_subscriber_ = direct.subscribe(names::kRodState, kQueue, &ContactNode::receiveState, this, hints);
    diagnostics_.setHardwareID("none");
    diagnostics_.add("contact", this, &ContactNode::diagnose);
    timer_ =
        node_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.update(); });
  }

private:
  /** The first mesh, and the first one of a vessel_server that was started anew; in between vessel/moved tells all. */
  void receiveVessel(const VesselMeshConstPtr& message)
  {
    if (detector_ && message->version != 1)
      return;
    GetVessel vessel;
    // What is latched may be older than the wall that the rod is at.
    const bool newer = message->version != 1 && ros::service::call(node_.resolveName(names::kGetVessel), vessel);
    const VesselMesh& mesh = newer ? vessel.response.mesh : *message;
    auto detector = std::make_unique<contact::Detector>(fromMessage(mesh), law_, mesh.version);
    triangles_ = mesh.mesh.triangles.size();
    ROS_INFO("contact: vessel version %lu, %zu triangles", static_cast<unsigned long>(mesh.version),
             mesh.mesh.triangles.size());
    const std::lock_guard<std::mutex> lock(mutex_);
    detector_ = std::move(detector);
    version_ = mesh.version;
    for (auto moved = vessel.response.moved.rbegin(); moved != vessel.response.moved.rend(); ++moved)
      waiting_.push_front(boost::make_shared<WallDisplacement>(*moved));
  }

  void receiveMoved(const WallDisplacementConstPtr& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(message);
    if (!asked_)
      return;
    const RodStateConstPtr asked = std::move(asked_);
    asked_.reset();
    answer(asked);
  }

  void receiveState(const RodStateConstPtr& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    asked_.reset();
    if (detector_ && message->radius.size() == message->nodes.size() && message->margin.size() == message->nodes.size())
      answer(message);
  }

  /** Moves the wall up to the version that is asked for, and never beyond it. @return whether it is there */
  bool moveWallTo(std::uint64_t version)
  {
    for (; !waiting_.empty() && waiting_.front()->version <= version; waiting_.pop_front())
    {
      if (waiting_.front()->version != version_ + 1)
        continue;  // it is in the mesh already
      const intervention::WallDisplacement moved = fromMessage(*waiting_.front(), detector_->wall().vertices.size());
      detector_->moveVertices(moved.indices, moved.positions, ++version_);
    }
    return version == 0 || version_ == version;
  }

  /** A movement that cannot be used leaves the wall where it was: states that ask for more stay without an answer. */
  bool isWallAt(std::uint64_t version)
  {
    try
    {
      return moveWallTo(version);
    }
    catch (const InputError& error)
    {
      ROS_ERROR("contact: %s; the simulation pauses until there is a new vessel", error.what());
      waiting_.pop_front();
      return false;
    }
  }

  /** Answers with the wall that is asked for; without it when it comes. */
  void answer(const RodStateConstPtr& message)
  {
    if (!isWallAt(message->vessel_version))
    {
      asked_ = message;
      late_walls_ = late_walls_ + 1;
      return;
    }
    fromMessage(*message, query_);
    if (message->wanted_free_distance > 0.0)
      detector_->freeDistances(query_, message->wanted_free_distance, answer_.set);
    else
      detector_->detect(query_, answer_.set);
    answer_.header.stamp = ros::Time::now();
    answer_.header.frame_id = names::kPatientFrame;
    publisher_.publish(answer_);
    ++answered_;
    features_ = answer_.set.features.size();
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
    status.add("vessel version", version_.load());
    status.add("waited for the vessel server", late_walls_.load());
  }

  ros::NodeHandle node_;
  RealTimeGrant grant_;
  contact::WallLaw law_;
  std::mutex mutex_;                              ///< vessels come in another thread than all else
  std::unique_ptr<contact::Detector> detector_;   ///< guarded, as the next two
  std::deque<WallDisplacementConstPtr> waiting_;  ///< movements that no state has asked for yet
  RodStateConstPtr asked_;                        ///< that cannot be answered yet
  contact::Query query_;
  StampedContactSet answer_;
  // For /diagnostics, which another thread writes.
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<std::size_t> features_{0};
  std::atomic<std::size_t> triangles_{0};
  std::atomic<std::uint64_t> version_{0};
  std::atomic<std::uint64_t> late_walls_{0};
  ros::Publisher publisher_;
  DirectCallbackQueue queue_;
  ros::Subscriber vessel_subscriber_, moved_subscriber_, state_subscriber_;
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
    nodes::spinUntilShutdown();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("contact: %s", error.what());
    return 1;
  }
  return 0;
}
