#include "vessel/anatomy/tube.h"

#include <cmath>

#include <Eigen/Geometry>

#include "common/error.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Station of the axis: position, tangent and parallel-transported `up`. */
struct Station
{
  Eigen::Vector3d position;
  Eigen::Vector3d tangent;
  Eigen::Vector3d up;
};

void requireShape(const TubeShape& shape)
{
  const auto reject = [](const std::string& key, const std::string& remedy) { throw InputError("tube", key, remedy); };
  if (!(shape.radius > 0.0))
    reject("radius", "must be positive [m]");
  if (!(shape.facet_length > 0.0))
    reject("facet_length", "must be positive [m]");
  if (shape.facets_around < 3)
    reject("facets_around", "must be at least 3");
  if (shape.pieces.empty())
    reject("pieces", "must contain at least one piece");
  for (const TubePiece& piece : shape.pieces)
  {
    if (!(piece.length > 0.0))
      reject("pieces", "every length must be positive [m]");
    if (!(std::abs(piece.curvature) * shape.radius < 1.0))
      reject("pieces", "a curvature must be less than 1/radius");
  }
  if (shape.direction.cross(shape.up).norm() < 1e-9)
    reject("up", "must not be parallel to the direction");
}

/** Station at arc length s of a piece that begins at @p start. */
Station advance(const Station& start, const TubePiece& piece, double s)
{
  const double angle = piece.curvature * s;
  if (angle == 0.0)
    return {start.position + s * start.tangent, start.tangent, start.up};
  const Eigen::Vector3d side = start.tangent.cross(start.up);
  const Eigen::Vector3d normal = std::cos(piece.plane_angle) * start.up + std::sin(piece.plane_angle) * side;
  const Eigen::Vector3d centre = start.position + normal / piece.curvature;
  const Eigen::AngleAxisd turn(angle, start.tangent.cross(normal));
  return {centre - turn * normal / piece.curvature, turn * start.tangent, turn * start.up};
}

/** Stations of the axis from the cap of the run-in to the far cap. Their spacing on the outer side of a bend is at most
 *  facet_length. */
std::vector<Station> stations(const TubeShape& shape)
{
  requireShape(shape);
  Station at;
  at.tangent = shape.direction.normalized();
  at.up = (shape.up - shape.up.dot(at.tangent) * at.tangent).normalized();
  TubePiece run_in;
  run_in.length = kTubeRunIn * shape.radius;
  at.position = shape.position - run_in.length * at.tangent;

  std::vector<TubePiece> pieces{run_in};
  pieces.insert(pieces.end(), shape.pieces.begin(), shape.pieces.end());
  std::vector<Station> all{at};
  for (const TubePiece& piece : pieces)
  {
    const double outer_length = piece.length * (1.0 + std::abs(piece.curvature) * shape.radius);
    const int count = std::max(1, static_cast<int>(std::ceil(outer_length / shape.facet_length - 1e-9)));
    for (int k = 1; k <= count; ++k)
      all.push_back(advance(at, piece, piece.length * k / count));
    at = all.back();
  }
  return all;
}

}  // namespace

geometry::TriangleMesh tubeMesh(const TubeShape& shape)
{
  const std::vector<Station> axis = stations(shape);
  const int around = shape.facets_around;
  geometry::TriangleMesh mesh;
  for (const Station& station : axis)
  {
    const Eigen::Vector3d side = station.tangent.cross(station.up);
    for (int k = 0; k < around; ++k)
    {
      const double angle = 2.0 * M_PI * k / around;
      mesh.vertices.push_back(station.position +
                              shape.radius * (std::cos(angle) * station.up + std::sin(angle) * side));
    }
  }
  const int last_ring = (static_cast<int>(axis.size()) - 1) * around;
  for (int ring = 0; ring < last_ring; ring += around)
    for (int k = 0; k < around; ++k)
    {
      const int a = ring + k;
      const int b = ring + (k + 1) % around;
      mesh.triangles.emplace_back(a, b, b + around);
      mesh.triangles.emplace_back(a, b + around, a + around);
    }
  const int near_cap = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(axis.front().position);
  mesh.vertices.push_back(axis.back().position);
  for (int k = 0; k < around; ++k)
  {
    const int next = (k + 1) % around;
    mesh.triangles.emplace_back(near_cap, next, k);
    mesh.triangles.emplace_back(near_cap + 1, last_ring + k, last_ring + next);
  }
  return mesh;
}

CentrelineTree tubeCentreline(const TubeShape& shape)
{
  CentrelineBranch branch;
  branch.name = "tube";
  for (const Station& station : stations(shape))
  {
    branch.points.push_back(station.position);
    branch.radii.push_back(shape.radius);
  }
  return {{branch}};
}

}  // namespace endovascular_sim::vessel
