#include "common/releases.h"

#include <algorithm>

namespace endovascular_sim
{
namespace
{

template <typename Condition>
std::string newest(const std::vector<Release>& all, Condition condition)
{
  const auto found = std::find_if(all.rbegin(), all.rend(), condition);
  return found == all.rend() ? "" : std::string("endovascular_sim ") + found->version;
}

}  // namespace

const std::vector<Release>& releases()
{
  static const std::vector<Release> all = {
      {"0.1.0", 8, 10},
  };
  return all;
}

const std::vector<FormerKey>& formerKeys()
{
  static const std::vector<FormerKey> all;  // no key of 0.1.0 has been removed
  return all;
}

std::string releaseOfPhysics(int physics, const std::vector<Release>& all)
{
  return newest(all, [physics](const Release& release) { return release.physics == physics; });
}

std::string releaseOfState(std::uint32_t format, int physics, const std::vector<Release>& all)
{
  return newest(all, [format, physics](const Release& release)
                { return release.state_format == format && (physics == 0 || release.physics == physics); });
}

std::string remedyOfFormerKey(std::string_view key, const std::vector<FormerKey>& all)
{
  const auto found = std::find_if(all.begin(), all.end(), [key](const FormerKey& former) { return former.key == key; });
  if (found == all.end())
    return "";
  return std::string("is a key of scenes of endovascular_sim ") + found->last_release + ", which reads it; use " +
         found->instead;
}

}  // namespace endovascular_sim
