#pragma once

#include <string>

namespace endovascular_sim::nodes
{

/** Writes a saved state. An earlier file of this name is replaced only by a complete one.
 *  @return complete path
 *  @throws InputError when the file cannot be written */
std::string writeStateFile(const std::string& file, const std::string& state);

/** Reads a saved state.
 *  @throws InputError for a file that cannot be read, or is no regular file */
std::string readStateFile(const std::string& file);

}  // namespace endovascular_sim::nodes
