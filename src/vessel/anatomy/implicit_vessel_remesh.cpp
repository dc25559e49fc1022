#include "vessel/anatomy/implicit_vessel_remesh.h"

#include <algorithm>
#include <cmath>

#include "vessel/repair/remesh.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kTolerance = 1e-9;  // distance from the zero level [m]

/** Remeshing target given by an implicit vessel. */
class ImplicitTarget : public RemeshTarget
{
public:
  explicit ImplicitTarget(const ImplicitVessel& field) : field_(field) {}

  /** Projects by Newton's method along the gradient. */
  TargetPoint project(const Eigen::Vector3d& start) const override
  {
    Eigen::Vector3d p = start;
    FieldSample sample = field_.at(p);
    for (int step = 0; step < 6 && std::abs(sample.distance) > kTolerance; ++step)
    {
      p -= sample.distance * sample.gradient / std::max(sample.gradient.squaredNorm(), 0.25);
      sample = field_.at(p);
    }
    return {p, sample.gradient.normalized(), sample.edge_length};
  }

private:
  const ImplicitVessel& field_;
};

}  // namespace

geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const ImplicitVessel& field)
{
  return remesh(mesh, ImplicitTarget(field));
}

}  // namespace endovascular_sim::vessel
