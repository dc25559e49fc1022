#include "nodes/session/session_files.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"

namespace endovascular_sim::nodes
{
namespace
{

namespace fs = std::filesystem;

/** Reports whether a bag has a name of the session node: session.bag, session_2.bag and so on. */
bool isPart(const fs::path& bag)
{
  constexpr std::string_view kName = "session";
  const std::string stem = bag.stem().string();
  if (stem.rfind(kName, 0) != 0)
    return false;
  const std::string number = stem.substr(kName.size());
  return number.empty() ||
         (number.size() > 1 && number[0] == '_' && number.find_first_not_of("0123456789", 1) == std::string::npos);
}

/** Order of bags: session.bag, session_2.bag, …, session_10.bag. */
bool isBefore(const fs::path& a, const fs::path& b)
{
  const std::string first = a.stem().string();
  const std::string second = b.stem().string();
  return std::pair(first.size(), first) < std::pair(second.size(), second);
}

/** Bags in a folder and below it, by their folder. */
std::map<fs::path, std::vector<fs::path>> bagsBelow(const fs::path& folder)
{
  std::map<fs::path, std::vector<fs::path>> bags;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file() && entry->path().extension() == ".bag")
      bags[entry->path().parent_path()].push_back(entry->path());
  if (error)
    throw InputError(folder.string(), "", "cannot be read (" + error.message() + "); give a folder of results");
  if (bags.empty())
    throw InputError(folder.string(), "", "holds no bag; give a session.bag, or a folder of results");
  for (auto& [parent, files] : bags)
    std::sort(files.begin(), files.end(), isBefore);
  return bags;
}

/** Name of a folder that no earlier session has. */
std::string uniqueName(const std::string& wanted, std::set<std::string>& taken)
{
  std::string name = wanted;
  for (int k = 2; !taken.insert(name).second; ++k)
    name = wanted + "_" + std::to_string(k);
  return name;
}

}  // namespace

std::vector<SessionFiles> sessionsOf(const std::vector<std::string>& paths)
{
  std::vector<SessionFiles> sessions;
  std::set<std::string> taken;
  for (const std::string& path : paths)
  {
    const fs::path given = fs::path(path).lexically_normal();
    if (!fs::is_directory(given))
    {
      const fs::path parent = fs::absolute(given).parent_path().filename();
      const std::string stem = given.stem().string();
      sessions.push_back(
          {path, uniqueName(stem == "session" && !parent.empty() ? parent.string() : stem, taken), {path}});
      continue;
    }
    const fs::path top = fs::absolute(given / "").parent_path();
    for (const auto& [folder, bags] : bagsBelow(given))
    {
      const fs::path below = folder.lexically_relative(given);
      const fs::path name = below == "." ? top.filename() : top.filename() / below;
      SessionFiles session{folder.string(), "", {}};
      for (const fs::path& bag : bags)
        if (isPart(bag))
          session.bags.push_back(bag.string());
        else
          sessions.push_back({bag.string(), uniqueName((name / bag.stem()).string(), taken), {bag.string()}});
      if (session.bags.empty())
        continue;
      session.folder = uniqueName(name.string(), taken);
      sessions.push_back(std::move(session));
    }
  }
  return sessions;
}

std::vector<std::string> bagsOf(const std::vector<std::string>& paths)
{
  std::vector<std::string> bags;
  for (const SessionFiles& session : sessionsOf(paths))
    bags.insert(bags.end(), session.bags.begin(), session.bags.end());
  return bags;
}

std::vector<std::string> bagsOfOneSession(const std::vector<std::string>& paths)
{
  std::vector<std::string> bags;
  for (const std::string& path : paths)
  {
    const std::vector<SessionFiles> sessions = sessionsOf({path});
    if (sessions.size() > 1)
      throw InputError(
          path, "",
          formatted("holds %zu sessions; give one of them, e.g. %s", sessions.size(), sessions.front().name.c_str()));
    bags.insert(bags.end(), sessions.front().bags.begin(), sessions.front().bags.end());
  }
  return bags;
}

}  // namespace endovascular_sim::nodes
