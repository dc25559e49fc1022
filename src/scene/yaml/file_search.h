#pragma once

#include <string>

#include "scene/yaml/yaml_tree.h"

namespace endovascular_sim::scene
{

/** The package's config folder: ENDOVASCULAR_CONFIG_DIR, or the one this program was built from. */
std::string configFolder();

/** Finds the file that a scene names by @p text. Relative paths are sought beside the scene, in the package's config
 *  folder, in the current folder and in ENDOVASCULAR_DATA_DIR, in this order; from an override in the current folder
 * first.
 *  @param node the value, for its place in errors
 *  @param path key path of the value
 *  @param scene_file the scene
 *  @throws InputError naming the folders when there is no such file */
std::string findSceneFile(const SceneNode& node, const std::string& path, const std::string& scene_file);

}  // namespace endovascular_sim::scene
