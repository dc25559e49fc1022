#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace endovascular_sim
{

/** Formats of a release (docs/RELEASES.md). */
struct Release
{
  const char* version;
  int physics;                 ///< kPhysicsNumber of the release: of bags that it computes, and of states
  std::uint32_t state_format;  ///< simulation::kStateFormat of the release
};

/** Key of scenes that a later release does not read any more. */
struct FormerKey
{
  const char* key;           ///< path in the scene, e.g. "drive.speed"
  const char* last_release;  ///< newest release that reads it
  const char* instead;       ///< key or value that takes its place; completes "use …"
};

/** All releases, oldest first. The last one is the version of this program. */
const std::vector<Release>& releases();

/** Keys of scenes of earlier releases. */
const std::vector<FormerKey>& formerKeys();

/** Newest release that computes bags of a physics number; empty without one. */
std::string releaseOfPhysics(int physics, const std::vector<Release>& all = releases());

/** Newest release that loads states of a format and a physics number; empty without one.
 *  @param physics 0: any */
std::string releaseOfState(std::uint32_t format, int physics, const std::vector<Release>& all = releases());

/** Release that reads a key of former scenes, and what takes the place of the key, as a remedy; empty for any other
 * key. */
std::string remedyOfFormerKey(std::string_view key, const std::vector<FormerKey>& all = formerKeys());

}  // namespace endovascular_sim
