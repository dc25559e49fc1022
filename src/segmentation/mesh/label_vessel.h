#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"
#include "segmentation/labels/mask_repair.h"
#include "segmentation/lumen/scan.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/prepare_report.h"

namespace endovascular_sim::segmentation
{

/** Settings of a vessel from a label map. */
struct LabelSettings
{
  std::vector<std::string> names;       ///< of the labels 1, 2, … of the map, as branches
  std::vector<Eigen::Vector3d> clicks;  ///< patient frame [m]: the ends beside them become open
  /** Selectors of ends as of vessel::matchingEnds(), in the frame of the patient: the only ones that become open, and
   * those that stay closed. @{ */
  std::vector<std::string> open;
  std::vector<std::string> closed;
  /** @} */
  double max_distance = 0.0;  ///< of the mesh from the smooth surface of the mask [m]; 0: 0.4 voxels
  double cut_back = 0.75;     ///< distance of the cut from the tip of an end within the image, in radii of the lumen
};

/** Opened end of a label's vessel. */
struct LabelOpening
{
  std::string branch;
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< grid frame [m]
  double radius = 0.0;                                 ///< [m]
  bool at_border = false;                              ///< the mask ends there at the border of the image
};

/** Vessel of a label map, in the grid frame of the scan; toPatient() transforms mesh and centreline. */
struct LabelVessel
{
  geometry::TriangleMesh mesh;           ///< closed except for its open ends [m]
  geometry::TriangleMesh closed;         ///< before its ends were opened [m]
  vessel::CentrelineTree centreline;     ///< up to the border of the image [m]
  vessel::PrepareReport report;          ///< of the mesh
  MaskChanges changes;                   ///< of the mask
  std::vector<Eigen::Vector3d> touches;  ///< places where the vessel touches the border without an end [m]
  std::vector<LabelOpening> openings;
  double mask_volume = 0.0;  ///< of the repaired mask, within the image [m³]
  int genus = 0;             ///< of the closed mesh
  std::vector<std::string> warnings;
};

/** Makes a vessel of the labels of a map.
 *
 *  Pieces, holes and loops of the mask are repaired (labels/mask_repair.h), and ends at the border of the image are
 * found (labels/mask_border.h). The surface is the zero level of the smooth field of the mask (labels/mask_field.h).
 * The stages of vessel::prepareVessel() mesh it and find the centreline. Without clicks and selectors, the ends at the
 *  border become open, or all ends if none lies there.
 *  @param scan labels as the values 1, 2, …; 0 elsewhere
 *  @param source name of the label map in errors
 *  @throws InputError for clicks without an end beside them, and selectors that match no end
 *  @throws UnusableSurface (segmented_vessel.h) for a lumen that is narrower than about two voxels */
LabelVessel labelVessel(const Scan& scan, const LabelSettings& settings, const std::string& source,
                        const std::function<void(const std::string& stage)>& stage = {});

}  // namespace endovascular_sim::segmentation
