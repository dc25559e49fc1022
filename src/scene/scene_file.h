#pragma once

#include <string>
#include <vector>

#include "scene/model/scene.h"

namespace endovascular_sim::scene
{

/** Reads, completes and checks a scene.
 *  @param file path of the YAML file
 *  @param overrides `key.path=value` texts, applied in order before checking
 *  @throws InputError naming file, key and remedy for an unknown key, a missing or impossible value, a missing file */
Scene loadScene(const std::string& file, const std::vector<std::string>& overrides = {});

/** The same from a text; @p origin names it in errors, and relative paths are sought beside it. */
Scene parseScene(const std::string& yaml, const std::string& origin, const std::vector<std::string>& overrides = {});

/** From the resolved text of a recording that holds the vessel itself: the vessel's files need not be there. */
Scene parseRecordedScene(const std::string& yaml, const std::string& origin);

}  // namespace endovascular_sim::scene
