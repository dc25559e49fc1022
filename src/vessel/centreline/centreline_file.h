#pragma once

#include <string>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Writes a centreline tree as an anatomy file in metres, readable by readAnatomy().
 *  @param name name of the anatomy
 *  @throws InputError if the file cannot be written */
void writeCentreline(const CentrelineTree& tree, const std::string& name, const std::string& path);

}  // namespace endovascular_sim::vessel
