#include "nodes/runtime/node_program.h"

#include <atomic>
#include <csignal>
#include <exception>
#include <memory>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>

#include "common/error.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/processor/processor_claim.h"
#include "nodes/runtime/progress_watchdog.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Set by the signal handler, read by all threads. */
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void requestStop(int /*signal*/)
{
  stop_requested = true;
  ros::requestShutdown();  // sets a flag, as the handler of ROS does
}

/** Makes a shutdown by another node (`rosnode kill`, shutDownNode()) act as SIGINT: the node ends its work before ROS
 * does. */
void followShutdownCalls()
{
  ros::XMLRPCManager& manager = *ros::XMLRPCManager::instance();
  manager.unbind("shutdown");
  manager.bind("shutdown",
               [](XmlRpc::XmlRpcValue& /*request*/, XmlRpc::XmlRpcValue& response)
               {
                 response = ros::xmlrpc::responseInt(1, "", 0);
                 requestStop(SIGINT);
               });
}

std::atomic<unsigned long>& progressCounter()
{
  static std::atomic<unsigned long> counter{0};
  return counter;
}

/** Scheduling of one process: its processors at the start, its policy on request. */
class ProcessScheduling
{
public:
  explicit ProcessScheduling(const NodeProgram& program)
    : program_(program), claim_(ros::master::getURI(), allowedProcessors())
  {
    if (program_.scheduling == NodeScheduling::kLockStep)
      pinned_ = useProcessor(claim_.choice().processor);
    else
      avoidProcessor(claim_.choice().processor);
  }

  SchedulingGrant request()
  {
    SchedulingGrant grant = requestPolicy();
    if (isRealTime() && grant.granted)
      startWatchdog(grant);
    if (pinned_)
    {
      grant.message += ", processor " + std::to_string(claim_.choice().processor);
      grant.other_sessions = [this] { return claim_.otherSessions(); };
    }
    report(grant);
    return grant;
  }

  /** Ends real-time scheduling before ROS shuts down, which may wait for a master that is gone. */
  void leave()
  {
    watchdog_.reset();
    if (isRealTime())
      leaveRealTimeInProcess();
  }

private:
  bool isRealTime() const
  {
    return program_.scheduling == NodeScheduling::kLockStep || program_.scheduling == NodeScheduling::kRealTime;
  }

  void startWatchdog(SchedulingGrant& grant)
  {
    const auto withdraw = []
    {
      leaveRealTimeInProcess();
      ROS_ERROR("scheduling: the loop makes no progress; real-time scheduling is withdrawn until the node restarts");
    };
    watchdog_ = superviseScheduling(grant, progressCounter(), program_.priority + 1, withdraw);
  }

  SchedulingGrant requestPolicy() const
  {
    switch (program_.scheduling)
    {
      case NodeScheduling::kLockStep:
        return requestLockStepScheduling(program_.priority);
      case NodeScheduling::kRealTime:
        return requestRealTimeScheduling(program_.priority);
      case NodeScheduling::kIdle:
        return requestIdleScheduling();
      case NodeScheduling::kDefault:
        break;
    }
    return {};
  }

  void report(const SchedulingGrant& grant) const
  {
    if (!grant.granted)
      ROS_WARN("scheduling: %s", grant.message.c_str());
    else if (program_.scheduling != NodeScheduling::kDefault)
      ROS_INFO("scheduling: %s", grant.message.c_str());
    if (pinned_ && !claim_.isVisible())
      ROS_WARN(
          "scheduling: no claim on processor %d, because the files in %s are held or unreadable; another session "
          "may choose it too; remedy: end the process that holds them (fuser %s/*)",
          claim_.choice().processor, kClaimFolder, kClaimFolder);
    if (pinned_ && claim_.choice().other_sessions > 0)
      ROS_WARN(
          "scheduling: %zu other session(s) use processor %d too, because every processor is in use; steps may be "
          "late",
          claim_.choice().other_sessions, claim_.choice().processor);
  }

  NodeProgram program_;
  ProcessorClaim claim_;
  bool pinned_ = false;
  std::unique_ptr<ProgressWatchdog> watchdog_;
};

/** Reports a refused parameter or scene at 1 Hz until ROS ends: a restarted node would refuse it again. */
void reportRefusal(const std::string& reason)
{
  diagnostic_updater::Updater diagnostics;
  diagnostics.setHardwareID("none");
  diagnostics.add("start", [&reason](diagnostic_updater::DiagnosticStatusWrapper& status)
                  { status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "not started: " + reason); });
  const ros::WallDuration period(1.0);
  while (ros::ok() && !stop_requested)
  {
    publishDiagnostics(diagnostics);
    ros::getGlobalCallbackQueue()->callAvailable(period);
  }
}

}  // namespace

bool isStopRequested()
{
  return stop_requested;
}

void countProgress()
{
  ++progressCounter();
}

int runNode(int argc, char** argv, const NodeProgram& program,
            const std::function<bool(ros::NodeHandle& node, const SchedulingRequest& request)>& run)
{
  ros::init(argc, argv, program.name, ros::init_options::NoSigintHandler);
  std::signal(SIGINT, requestStop);
  ProcessScheduling scheduling(program);  // ROS starts its threads with the node handle: they inherit the processors
  ros::NodeHandle node;
  followShutdownCalls();
  try
  {
    const bool succeeded = run(node, [&scheduling] { return scheduling.request(); });
    scheduling.leave();
    return succeeded ? 0 : 1;
  }
  catch (const InputError& error)
  {
    scheduling.leave();
    ROS_FATAL("%s", error.what());
    if (ros::param::param("~stay_after_refusal", false))
      reportRefusal(error.what());
    return 1;
  }
  catch (const std::exception& error)
  {
    scheduling.leave();
    ROS_FATAL("%s", error.what());
    return 1;
  }
}

}  // namespace endovascular_sim::nodes
