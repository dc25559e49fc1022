#include "vessel/anatomy/mesh_centreline.h"

#include <algorithm>

#include "common/error.h"
#include "geometry/mesh_distance.h"
#include "vessel/anatomy/anatomy.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kProbes = 40;    ///< points of a branch that are checked, at most
constexpr double kMostOutside = 0.05;  ///< share of them that may lie outside: the ends before the open ends of a mesh

void requireInside(const CentrelineBranch& branch, const geometry::TriangleMesh& mesh, const std::string& file)
{
  const std::size_t n = branch.points.size();
  const std::size_t probes = std::min(kProbes, n);
  std::size_t outside = 0;
  const Eigen::Vector3d* example = nullptr;
  for (std::size_t k = 0; k < probes; ++k)
  {
    const Eigen::Vector3d& p = branch.points[(2 * k + 1) * n / (2 * probes)];
    if (geometry::windingNumber(mesh, p) > 0.5)
      continue;
    ++outside;
    example = &p;
  }
  if (static_cast<double>(outside) > kMostOutside * static_cast<double>(probes))
    throw InputError(
        file, "branches." + branch.name,
        "leaves the vessel: " + formatLocation(*example) +
            " lies outside of the mesh; give the centreline of this mesh, in the same frame, with its unit");
}

}  // namespace

CentrelineTree readMeshCentreline(const std::string& file, const Eigen::Isometry3d& transform,
                                  const geometry::TriangleMesh& mesh)
{
  const Anatomy anatomy = readAnatomy(file);
  CentrelineTree tree = anatomyCentreline(anatomy, sampleChains(anatomy));
  for (CentrelineBranch& branch : tree.branches)
  {
    for (Eigen::Vector3d& p : branch.points)
      p = transform * p;
    requireInside(branch, mesh, file);
  }
  return tree;
}

}  // namespace endovascular_sim::vessel
