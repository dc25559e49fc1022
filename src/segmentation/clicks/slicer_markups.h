#pragma once

#include <string>

#include "segmentation/clicks/click_set.h"

namespace endovascular_sim::segmentation
{

/** Reads a markups file of 3D Slicer in JSON (.mrk.json).
 *  @throws InputError for a file that is none, an unknown unit, an unknown coordinate system, a closed
 *          curve, an angle, a plane or a region, and a point without a label among labelled ones */
ClickSet readMarkupsJson(const std::string& file);

/** Reads a fiducial list of 3D Slicer 4 (.fcsv).
 *  @throws InputError for a file that is none, an unknown coordinate system, a line without a position, and a point
 * without a label among labelled ones */
ClickSet readFiducialCsv(const std::string& file);

}  // namespace endovascular_sim::segmentation
