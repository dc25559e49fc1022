#pragma once

#include <string>
#include <utility>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>

#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Topic below instruments/ to which a client publishes although rod_dynamics does not read it. */
struct UnreadTopic
{
  std::string topic;
  std::string remedy;  ///< e.g. "the scene has no instrument 'x'; publish to /instruments/guidewire/servo_jp"
};

/** Judges published topics.
 *  @param prefix resolved name of instruments/, with the slash
 *  @param published topics with the names of their publishers
 *  @param self name of this node, whose own topics are none */
std::vector<UnreadTopic> unreadTopics(const scene::Scene& scene, const std::string& prefix,
                                      const std::vector<std::pair<std::string, std::vector<std::string>>>& published,
                                      const std::string& self);

/** All topics with the names of their publishers, as the master lists them; empty if the master does not answer. */
std::vector<std::pair<std::string, std::vector<std::string>>> publishedTopics();

/** Adds a warning for each topic to the diagnostics. */
void diagnoseUnread(const std::vector<UnreadTopic>& unread, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace endovascular_sim::nodes
