#pragma once

#include <cstdint>
#include <string>

#include "scene/model/scene.h"

namespace endovascular_sim::scene
{

/** Text of a scene in which only the names remain of files with an absolute path: it is the same in every folder, and
 * names no user. */
std::string withoutFolders(const std::string& yaml);

/** Scene::motionHash() as states of former versions hold it: with the folders of files. */
std::uint64_t formerMotionHash(const Scene& scene);

}  // namespace endovascular_sim::scene
