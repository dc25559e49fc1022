#pragma once

#include <fstream>
#include <ios>
#include <string>

namespace endovascular_sim
{

/** Opens a file for reading.
 *  @param remedy what the file must be, e.g. "give the path of a state saved with --save-state"
 *  @throws InputError with the reason of the operating system for a missing or unreadable file and for a folder */
std::ifstream openInputFile(const std::string& file, const std::string& remedy, std::ios::openmode mode = std::ios::in);

}  // namespace endovascular_sim
