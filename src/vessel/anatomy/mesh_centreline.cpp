#include "vessel/anatomy/mesh_centreline.h"

#include <algorithm>
#include <vector>

#include "common/error.h"
#include "geometry/mesh_distance.h"
#include "vessel/anatomy/anatomy.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/io/vtk_centreline.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kProbes = 40;    ///< points of a branch that are checked, at most
constexpr double kMostOutside = 0.05;  ///< share of them that may lie outside of the mesh
/** Length at each end of a branch that is not checked, in radii: the mesh is cut before the end of its centreline. */
constexpr double kUncheckedEnd = 1.0;

/** Points of a branch at more than kUncheckedEnd radii from both of its ends, or its middle point if there are none. */
std::vector<Eigen::Vector3d> pointsAwayFromEnds(const CentrelineBranch& branch)
{
  const auto isAwayFrom = [](const Eigen::Vector3d& p, const Eigen::Vector3d& end, double radius)
  { return (p - end).norm() > kUncheckedEnd * radius; };
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : branch.points)
    if (isAwayFrom(p, branch.points.front(), branch.radii.front()) &&
        isAwayFrom(p, branch.points.back(), branch.radii.back()))
      points.push_back(p);
  if (points.empty())
    points.push_back(branch.points[branch.points.size() / 2]);
  return points;
}

void requireInside(const CentrelineBranch& branch, const geometry::TriangleMesh& mesh, const std::string& file)
{
  const std::vector<Eigen::Vector3d> points = pointsAwayFromEnds(branch);
  const std::size_t n = points.size();
  const std::size_t probes = std::min(kProbes, n);
  std::size_t outside = 0;
  const Eigen::Vector3d* example = nullptr;
  for (std::size_t k = 0; k < probes; ++k)
  {
    const Eigen::Vector3d& p = points[(2 * k + 1) * n / (2 * probes)];
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

CentrelineTree readAnatomyTree(const std::string& file)
{
  const Anatomy anatomy = readAnatomy(file);
  return anatomyCentreline(anatomy, sampleChains(anatomy));
}

CentrelineTree readVtkTree(const std::string& file, double unit, const Eigen::Isometry3d& transform,
                           geometry::TriangleMesh mesh)
{
  const Eigen::Isometry3d back = transform.inverse();
  for (Eigen::Vector3d& v : mesh.vertices)
    v = back * v;
  const std::string bytes = readMeshFile(file);
  return vtkCentreline(readVtkPolyData(bytes, file), unit, geometry::MeshDistance(mesh), file);
}

}  // namespace

CentrelineTree readMeshCentreline(const std::string& file, double unit, const Eigen::Isometry3d& transform,
                                  const geometry::TriangleMesh& mesh)
{
  CentrelineTree tree = isVtkFile(file) ? readVtkTree(file, unit, transform, mesh) : readAnatomyTree(file);
  for (CentrelineBranch& branch : tree.branches)
  {
    for (Eigen::Vector3d& p : branch.points)
      p = transform * p;
    requireInside(branch, mesh, file);
  }
  return tree;
}

}  // namespace endovascular_sim::vessel
