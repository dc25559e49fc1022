#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/error.h"
#include "geometry/triangle_mesh.h"
#include "segmentation/clicks/click_set.h"
#include "segmentation/lumen/edge_model.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/segment_vessel.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/prepare_report.h"

namespace endovascular_sim::segmentation
{

/** Settings of a segmentation from clicks to a mesh. */
struct VesselSettings
{
  EdgeSettings edge;  ///< see edgeSettings()
  /** Selectors of the ends that become open, and of those that stay closed, as of vessel::matchingEnds(), in the frame
   *  of the patient. @{ */
  std::vector<std::string> open = {"all"};
  std::vector<std::string> closed;
  /** @} */
  double max_distance = 2e-4;  ///< of the mesh from the contours [m]
  double cut_back = 0.75;      ///< distance of an open end from the last contour, in radii of the lumen
  int threads = 0;             ///< 0: number of processors; the result does not depend on it
};

/** What a caller sees of a segmentation before its end. */
struct VesselObserver
{
  std::function<void(const std::string& stage)> stage;                      ///< at the beginning of every stage
  std::function<void(const std::vector<LumenBranch>& branches)> segmented;  ///< also where no mesh can be made of them
};

/** Vessel of a scan, in the grid frame; toPatient() transforms mesh and centreline. */
struct SegmentedVessel
{
  std::vector<LumenBranch> branches;
  geometry::TriangleMesh mesh;        ///< closed except for its open ends [m]
  vessel::CentrelineTree centreline;  ///< [m]
  vessel::PrepareReport report;       ///< of the mesh
  int open_ends = 0;
  std::vector<std::string> warnings;
};

/** The surface encloses no volume of which a mesh could be made. */
class UnusableSurface : public InputError
{
public:
  explicit UnusableSurface(const InputError& reason) : InputError(reason) {}
};

/** Segments branches by their clicks, unites them, meshes their surface and opens its ends.
 *  @param source name of the images in errors
 *  @throws InputError for clicks, branches or selectors that are refused (segmentBranches(), joinBranches(),
 *          vessel::matchingEnds())
 *  @throws UnusableSurface */
SegmentedVessel segmentVessel(const Scan& scan, const ClickSet& clicks, const VesselSettings& settings,
                              const std::string& source, const VesselObserver& observer = {});

}  // namespace endovascular_sim::segmentation
