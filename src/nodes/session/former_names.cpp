#include "nodes/session/former_names.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

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

/** Separator between the fields of a message and the definitions of their types. */
constexpr auto kSeparator = "====";

/** Definitions of a text: that of the message, then those of the types of its fields. */
std::vector<std::string> sections(const std::string& definition)
{
  std::vector<std::string> parts(1);
  std::istringstream lines(presentFields(definition));
  for (std::string line; std::getline(lines, line);)
  {
    if (line.rfind(kSeparator, 0) == 0)
      parts.emplace_back();
    else
      parts.back() += line + '\n';
  }
  return parts;
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

bool hasFirstFields(const std::string& recorded, const std::string& present)
{
  const std::vector<std::string> old = sections(recorded);
  const std::vector<std::string> now = sections(present);
  if (old.front().empty() || now.front().rfind(old.front(), 0) != 0)
    return false;
  return std::all_of(old.begin() + 1, old.end(),
                     [&](const std::string& type) { return std::find(now.begin() + 1, now.end(), type) != now.end(); });
}

}  // namespace endovascular_sim::nodes
