#include "nodes/rod_dynamics/instruments/unread_topics.h"

#include <algorithm>

#include <ros/master.h>
#include <ros/this_node.h>

#include "common/text/words.h"
#include "drive/joint_command.h"
#include "nodes/runtime/ros_names.h"
#include "scene/schema/scene_schema.h"
#include "simulation/driven_hands.h"

namespace endovascular_sim::nodes
{
namespace
{

const std::vector<std::string> kInputs = {"servo_jp", "servo_jr", "servo_jv", "servo_jf",     "move_jp",
                                          "move_jr",  "hold",     "free",     "state_command"};

/** Reason for which a topic is not read; empty if it is. */
std::string remedyFor(const scene::Scene& scene, const std::string& prefix, const std::string& instrument,
                      const std::string& input)
{
  std::vector<std::string> known;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    known.push_back(driven.instrument.name);
  const auto found = std::find(known.begin(), known.end(), instrument);
  const bool is_input = std::find(kInputs.begin(), kInputs.end(), input) != kInputs.end();
  const std::string nearest_input = nearestWord(input, kInputs);
  const std::string right_input = is_input ? input : nearest_input.empty() ? kInputs.front() : nearest_input;
  if (found == known.end())
  {
    const std::string nearest = nearestWord(instrument, known);
    return "the scene has no instrument '" + instrument + "'; publish to " + prefix +
           (nearest.empty() ? known.front() : nearest) + "/" + right_input;
  }
  const auto k = static_cast<std::size_t>(found - known.begin());
  if (!is_input)
    return "instruments have no input '" + input + "'; publish to " + prefix + instrument + "/" + right_input;
  if (!simulation::isCommanded(scene.instruments[k]))
    return "the scene drives '" + instrument + "' itself; set " + scene::drivePath(scene, k) + "drive.source=topic";
  return "";
}

}  // namespace

std::vector<UnreadTopic> unreadTopics(const scene::Scene& scene, const std::string& prefix,
                                      const std::vector<std::pair<std::string, std::vector<std::string>>>& published,
                                      const std::string& self)
{
  std::vector<UnreadTopic> unread;
  for (const auto& [topic, publishers] : published)
  {
    const bool is_own = std::find(publishers.begin(), publishers.end(), self) != publishers.end();
    const std::size_t slash = topic.rfind('/');
    if (is_own || topic.compare(0, prefix.size(), prefix) != 0 || slash < prefix.size())
      continue;
    const std::string remedy =
        remedyFor(scene, prefix, topic.substr(prefix.size(), slash - prefix.size()), topic.substr(slash + 1));
    if (!remedy.empty())
      unread.push_back({topic, remedy});
  }
  return unread;
}

std::vector<std::pair<std::string, std::vector<std::string>>> publishedTopics()
{
  std::vector<std::pair<std::string, std::vector<std::string>>> topics;
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  if (!ros::master::execute("getSystemState", request, response, state, false))
    return topics;
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int i = 0; i < publishers.size(); ++i)
  {
    std::vector<std::string> nodes;
    for (int k = 0; k < publishers[i][1].size(); ++k)
      nodes.push_back(publishers[i][1][k]);
    topics.emplace_back(publishers[i][0], std::move(nodes));
  }
  return topics;
}

void diagnoseUnread(const std::vector<UnreadTopic>& unread, diagnostic_updater::DiagnosticStatusWrapper& status)
{
  for (const UnreadTopic& topic : unread)
  {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "nobody reads " + topic.topic + ": " + topic.remedy);
    status.add(topic.topic + ": not read", topic.remedy);
  }
}

}  // namespace endovascular_sim::nodes
