#include "patient/body/body_placement.h"

#include <algorithm>

#include "common/text/format.h"
#include "patient/body/spine.h"

namespace endovascular_sim::patient
{
namespace
{

constexpr double kMinScale = 0.8;
constexpr double kMaxScale = 1.25;
constexpr double kTallVessel = 0.35;  // [m]
// The vessels of which the body is the surroundings, in its frame [mm].
constexpr double kArchHeight = 311.0;  // highest point of the centreline of the arch above the bifurcation
constexpr double kTreeHeight = 653.0;  // from the groins to the neck
constexpr double kTreeMiddle = 113.0;  // z of the tree's middle
constexpr double kTreeDepth = -20.0;   // y of the tree's middle
const Eigen::Vector3d kHeart(10.0, -30.0, 170.0);

const vessel::CentrelineBranch* branchNamed(const vessel::CentrelineTree& tree, const std::string& name)
{
  for (const vessel::CentrelineBranch& branch : tree.branches)
    if (branch.name == name && !branch.points.empty())
      return &branch;
  return nullptr;
}

BodyPlacement byLandmarks(const vessel::CentrelineBranch& abdominal, const vessel::CentrelineBranch& arch)
{
  const Eigen::Vector3d bifurcation = abdominal.points.back();
  double top = arch.points.front().z();
  for (const Eigen::Vector3d& p : arch.points)
    top = std::max(top, p.z());
  BodyPlacement placement;
  placement.frame.scale = std::clamp((top - bifurcation.z()) / (1e-3 * kArchHeight), kMinScale, kMaxScale);
  placement.frame.origin = bifurcation;
  placement.by_landmarks = true;
  placement.note = formatted("body placed by the aortic bifurcation and the aortic arch, at %.0f %% of its usual size",
                             100.0 * placement.frame.scale);
  return placement;
}

BodyPlacement byExtent(const geometry::TriangleMesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  BodyPlacement placement;
  if (box.isEmpty())
  {
    placement.note = "body placed at the origin: there is no vessel";
    return placement;
  }
  const Eigen::Vector3d middle = box.center();
  const double height = box.sizes().z();
  if (height > kTallVessel)
  {
    placement.frame.scale = std::clamp(height / (1e-3 * kTreeHeight), kMinScale, kMaxScale);
    placement.frame.origin = middle - 1e-3 * placement.frame.scale * Eigen::Vector3d(0.0, kTreeDepth, kTreeMiddle);
    placement.note = formatted(
        "body fitted to the vessel's extent, as a tree from groins to neck, at %.0f %% of its usual "
        "size: the vessel has no branches named abdominal_aorta and aortic_arch",
        100.0 * placement.frame.scale);
  }
  else
  {
    placement.frame.origin = middle - 1e-3 * kHeart;
    placement.note =
        "body placed with its heart at the middle of the vessel: the vessel has no branches named "
        "abdominal_aorta and aortic_arch";
  }
  return placement;
}

}  // namespace

BodyPlacement placeBody(const vessel::Vessel& vessel)
{
  const vessel::CentrelineBranch* abdominal = branchNamed(vessel.centreline, "abdominal_aorta");
  const vessel::CentrelineBranch* arch = branchNamed(vessel.centreline, "aortic_arch");
  return abdominal != nullptr && arch != nullptr ? byLandmarks(*abdominal, *arch) : byExtent(vessel.mesh);
}

}  // namespace endovascular_sim::patient
