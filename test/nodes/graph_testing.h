#pragma once

#include <signal.h>

#include <optional>
#include <string>

#include <XmlRpcClient.h>
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/ros.h>

namespace endovascular_sim
{

#ifdef ENDOVASCULAR_SANITIZED
constexpr double kSlowness = 10.0;  ///< factor of all time limits
#else
constexpr double kSlowness = 1.0;  ///< factor of all time limits
#endif

/** Thread that calls the callbacks of a program of tests; to be added with testing::AddGlobalTestEnvironment(). */
class CallbackThread : public testing::Environment
{
public:
  void SetUp() override { spinner_.emplace(1).start(); }
  void TearDown() override { spinner_.reset(); }

private:
  std::optional<ros::AsyncSpinner> spinner_;  ///< none before ros::init()
};

/** Waits until a condition holds. @return false when it did not hold within the time [s], times kSlowness */
template <typename Condition>
bool waitUntil(double seconds, Condition condition)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kSlowness * seconds);
  while (ros::WallTime::now() < end)
  {
    if (condition())
      return true;
    ros::WallDuration(0.005).sleep();
  }
  return condition();
}

/** Process of a node. @return 0 when the node was not found */
inline pid_t processOf(const std::string& name)
{
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = name;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, payload, false) ||
      !ros::network::splitURI(payload, host, port))
    return 0;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller, reply;
  caller[0] = ros::this_node::getName();
  return client.execute("getPid", caller, reply) ? static_cast<int>(reply[2]) : 0;
}

/** Kills a node, as a crash would. @return false when the node was not found */
inline bool killNode(const std::string& name)
{
  const pid_t process = processOf(name);
  return process > 0 && kill(process, SIGKILL) == 0;
}

}  // namespace endovascular_sim
