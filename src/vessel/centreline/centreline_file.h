#pragma once

#include <string>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Writes a centreline tree as an anatomy file (metres): readAnatomy() reads its branches, points and diameters.
 *  @param name of the anatomy
 *  @throws InputError when the file cannot be written */
void writeCentreline(const CentrelineTree& tree, const std::string& name, const std::string& path);

}  // namespace endovascular_sim::vessel
