#pragma once

#include <string>
#include <vector>

#include "segmentation/lumen/scan.h"
#include "segmentation/mesh/label_vessel.h"

namespace endovascular_sim::segmentation
{

/** Label of a vessel. */
struct ChosenLabel
{
  long number = 0;  ///< in the label map
  std::string name;
  std::size_t voxels = 0;
};

/** Cross-sections of a branch of a label's vessel. */
struct BranchSections
{
  std::vector<double> arc;       ///< arc length of the points of the centreline [m]
  std::vector<double> diameter;  ///< of the circle of equal area [m]
  std::size_t narrowest = 0;
};

/** Cross-sections of every branch. */
std::vector<BranchSections> sectionsOf(const LabelVessel& vessel);

/** Report in JSON, SI units: labels, changes of the mask, open ends, and per branch length, diameters and sections, as
 * in the report of a segmentation. It holds no name, number or date of the patient. */
std::string labelJson(const Scan& scan, const LabelVessel& vessel, const std::vector<ChosenLabel>& labels,
                      const std::vector<std::string>& warnings);

/** Changes of the mask and table of the branches, in millimetres. */
std::string labelText(const LabelVessel& vessel, const std::vector<ChosenLabel>& labels);

}  // namespace endovascular_sim::segmentation
