#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::segmentation
{

/** Centreline tree of joined branches in the grid frame, one branch per branch and with its name, parents before
 * their children. Points are about one radius apart. Radii are those of circles inscribed into the contours. A branch
 * leads straight from its parent's centreline to its ostium. Bends are as gentle as an anatomy needs them
 * (vessel/anatomy/anatomy.h). */
vessel::CentrelineTree lumenCentreline(const std::vector<LumenBranch>& branches);

/** Tree of the patient frame, from one of the grid frame. */
vessel::CentrelineTree toPatient(const Scan& scan, vessel::CentrelineTree tree);

/** Mesh of the patient frame, from one of the grid frame. */
geometry::TriangleMesh toPatient(const Scan& scan, geometry::TriangleMesh mesh);

/** Ends of the tree at which the vessel is cut: both ends of the root and the far ends of its branches, without those
 * at which another branch begins. */
std::vector<vessel::CentrelineEnd> openEnds(const vessel::CentrelineTree& tree);

}  // namespace endovascular_sim::segmentation
