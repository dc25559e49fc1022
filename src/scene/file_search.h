#pragma once

#include <string>

#include "yaml/tree.h"

namespace endovascular_sim::scene
{

/** The package's config folder: ENDOVASCULAR_CONFIG_DIR if set. Otherwise share/endovascular_sim/config in the nearest
 *  folder above the program or shared library that holds this function. An installation may therefore be moved. In the
 *  devel space that folder is a link to the sources. The folder need not exist. */
std::string configFolder();

/** Finds a file that a scene names in @p node. Relative paths are searched beside the scene, in the package's config
 *  folder, in the current folder and in ENDOVASCULAR_DATA_DIR, in this order. Those of an override are searched in the
 *  current folder first. A leading `~/` is the home folder.
 *  @param node the value, with its position for errors
 *  @param path key path of the value
 *  @param scene_file the scene
 *  @throws InputError naming the folders when there is no such file */
std::string findSceneFile(const yaml::Node& node, const std::string& path, const std::string& scene_file);

/** Finds an anatomy file. A single word such as `natural` names a file of the package's folder config/anatomies,
 * without
 *  `.yaml`; any other text is a path as in findSceneFile.
 *  @throws InputError listing the anatomies of the package for an unknown word */
std::string findAnatomy(const yaml::Node& node, const std::string& path, const std::string& scene_file);

/** Finds the file of a circulation in the same way: `adult` names a file of config/hemodynamics.
 *  @throws InputError listing those of the package for an unknown word */
std::string findCirculation(const yaml::Node& node, const std::string& path, const std::string& scene_file);

/** Finds the file of a patient's motion in the same way: `adult` names a file of config/motion.
 *  @throws InputError listing those of the package for an unknown word */
std::string findMotion(const yaml::Node& node, const std::string& path, const std::string& scene_file);

}  // namespace endovascular_sim::scene
