#pragma once

#include <string>

namespace endovascular_sim::nodes
{

/** Texts of a recording that displays need before it is played. */
struct RecordedTexts
{
  std::string scene;  ///< YAML of the scene; empty without session/info
  std::string urdf;   ///< of the scene's robot; empty without one
};

/** Reads the texts of a bag. A bag without the description of its robot has that of the file in its scene, if this
 *  exists.
 *  @throws InputError when the file is no bag */
RecordedTexts recordedTexts(const std::string& file);

}  // namespace endovascular_sim::nodes
