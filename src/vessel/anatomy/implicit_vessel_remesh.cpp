#include "vessel/anatomy/implicit_vessel_remesh.h"

#include <algorithm>
#include <cmath>

#include "vessel/repair/remesh.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kOnWall = 1e-9;  // [m]

class FieldWall : public RemeshWall
{
public:
  explicit FieldWall(const ImplicitVessel& field) : field_(field) {}

  /** Newton's method along the gradient. */
  WallPoint onWall(const Eigen::Vector3d& start) const override
  {
    Eigen::Vector3d p = start;
    FieldSample sample = field_.at(p);
    for (int step = 0; step < 6 && std::abs(sample.distance) > kOnWall; ++step)
    {
      p -= sample.distance * sample.gradient / std::max(sample.gradient.squaredNorm(), 0.25);
      sample = field_.at(p);
    }
    return {p, sample.gradient.normalized(), sample.facet};
  }

private:
  const ImplicitVessel& field_;
};

}  // namespace

geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const ImplicitVessel& field)
{
  return remesh(mesh, FieldWall(field));
}

}  // namespace endovascular_sim::vessel
