#include "nodes/runtime/node_shutdown.h"

#include <cstdint>

#include <ros/network.h>
#include <ros/ros.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace endovascular_sim::nodes
{
namespace
{

/** Address of a node's interface; empty when the master does not know the node. */
std::string addressOf(const std::string& node)
{
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  request[0] = ros::this_node::getName();
  request[1] = node;
  if (!ros::master::execute("lookupNode", request, response, payload, false))
    return "";
  return static_cast<std::string>(payload);
}

bool callShutdown(const std::string& address, const std::string& reason)
{
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(address, host, port))
    return false;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  request[0] = ros::this_node::getName();
  request[1] = reason;
  return client.execute("shutdown", request, response) && !client.isFault();
}

}  // namespace

bool shutDownNode(const std::string& name, const std::string& reason, double patience)
{
  const std::string node = ros::names::resolve(name);
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(patience);
  std::string address = addressOf(node);
  while (address.empty() && ros::ok() && ros::SteadyTime::now() < end)
  {
    ros::WallDuration(0.1).sleep();
    address = addressOf(node);
  }
  return !address.empty() && callShutdown(address, reason);
}

}  // namespace endovascular_sim::nodes
