#pragma once

#include <string>
#include <vector>

#include "scene/model/scene.h"

namespace endovascular_sim::scene
{

/** Loads, completes and validates a scene.
 *  @param file path of the YAML file
 *  @param overrides texts `key.path=value`, applied in order before validation
 *  @throws InputError with file, key and remedy, for an unknown key, a missing or invalid value, or a missing file */
Scene loadScene(const std::string& file, const std::vector<std::string>& overrides = {});

/** Parses, completes and validates the text of a scene.
 *  @param origin name of the text in errors; relative paths are searched next to it */
Scene parseScene(const std::string& yaml, const std::string& origin, const std::vector<std::string>& overrides = {});

/** Parses the resolved text of a recording. The recording contains the vessel, so the vessel's files may be missing. */
Scene parseRecordedScene(const std::string& yaml, const std::string& origin);

/** Pseudonym of the trainee, key `record.subject` of a scene file; empty without one. It is no part of the scene, whose
 * hash does not depend on it.
 *  @param file, overrides as for loadScene(), which has accepted them */
std::string recordSubject(const std::string& file, const std::vector<std::string>& overrides);

}  // namespace endovascular_sim::scene
