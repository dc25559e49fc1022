#include "nodes/session/former_names.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace endovascular_sim::nodes
{
namespace
{

/** Name of a former version, and the present one. */
using Renaming = std::pair<const char*, const char*>;

constexpr Renaming kTopics[] = {{"/vessel/pressing", "/vessel/balloon_load"},
                                {"/vessel/moved", "/vessel/wall_displacement"}};
constexpr Renaming kFields[] = {{" new_tries", " retries"}};

/** Replaces a former name at the end of a text. */
template <std::size_t size>
void rename(std::string& text, const Renaming (&renamings)[size])
{
  for (const auto& [former, present] : renamings)
  {
    const std::string name = former;
    if (text.size() >= name.size() && text.compare(text.size() - name.size(), std::string::npos, name) == 0)
      text.replace(text.size() - name.size(), std::string::npos, present);
  }
}

}  // namespace

std::string presentTopic(std::string topic)
{
  rename(topic, kTopics);
  return topic;
}

std::string presentFields(const std::string& definition)
{
  std::istringstream lines(definition);
  std::string fields;
  for (std::string line; std::getline(lines, line);)
  {
    line.resize(std::min(line.find('#'), line.size()));
    line.resize(line.find_last_not_of(" \t\r") + 1);
    rename(line, kFields);
    if (!line.empty())
      fields += line + '\n';
  }
  return fields;
}

}  // namespace endovascular_sim::nodes
