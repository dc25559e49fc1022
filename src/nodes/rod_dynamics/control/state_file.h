#pragma once

#include <string>

namespace endovascular_sim::nodes
{

/** Writes a saved state. Clients of a ROS graph are not authenticated: only a missing file, or one that is a saved
 * state, is written. It is replaced only by a complete one, and no link is followed at its name.
 *  @param folder folder that must contain the file, which is relative to it; empty: any folder
 *  @return complete path
 *  @throws InputError when the file is refused, or cannot be written */
std::string writeStateFile(const std::string& file, const std::string& state, const std::string& folder = "");

/** Reads a saved state. Kind of file, size and first bytes are checked before anything else is read.
 *  @param folder as above
 *  @throws InputError for a file that is refused, cannot be read, or is no saved state */
std::string readStateFile(const std::string& file, const std::string& folder = "");

}  // namespace endovascular_sim::nodes
