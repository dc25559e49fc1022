#include "intervention/lesion_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "geometry/polyline.h"
#include "vessel/centreline/lumen_section.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr int kSections = 40;           // sections along a lesion
constexpr double kTangentReach = 1e-3;  // half length of the chord that defines the normal of a section [m]
constexpr int kStentSections = 30;
constexpr int kStentRays = 32;
constexpr double kApposed = 0.1e-3;  // largest gap between an apposed strut and the wall [m]
constexpr double kTolerance = 1e-6;  // rounding tolerance of the gap [m]

/** Fraction of the stent's surface that is apposed to the wall. */
double apposition(const geometry::MeshDistance& wall, const RoundBody& stent)
{
  const geometry::Polyline axis(stent.axis);
  int apposed = 0;
  for (int k = 0; k < kStentSections; ++k)
  {
    const double arc = axis.length() * (k + 0.5) / kStentSections;
    const Eigen::Vector3d along = axis.tangentAt(arc);
    const Eigen::Vector3d u = along.unitOrthogonal();
    const Eigen::Vector3d v = along.cross(u);
    const double radius = axis.interpolate(stent.radii, arc);
    for (int ray = 0; ray < kStentRays; ++ray)
    {
      const double angle = 2.0 * M_PI * ray / kStentRays;
      const double hit = wall.rayHit(axis.at(arc), std::cos(angle) * u + std::sin(angle) * v);
      apposed += hit >= 0.0 && hit - radius <= kApposed + kTolerance ? 1 : 0;
    }
  }
  return static_cast<double>(apposed) / (kStentSections * kStentRays);
}

}  // namespace

LesionReport reportLesion(const geometry::TriangleMesh& mesh, const vessel::CentrelineTree& centreline,
                          const vessel::PlacedLesion& lesion, const RoundBody* stent)
{
  const vessel::CentrelineBranch& branch = centreline.branches[static_cast<std::size_t>(lesion.branch)];
  const geometry::Polyline axis(branch.points, kTangentReach);
  const geometry::MeshDistance wall(mesh);
  const auto diameterAt = [&](double arc)
  {
    const geometry::Polyline::Foot foot = axis.normalPlaneFoot(axis.at(arc));
    return vessel::lumenDiameter(wall, foot.point, foot.tangent);
  };
  const double before = std::max(0.0, lesion.begin - lesion.healthy_diameter);
  const double after = std::min(axis.length(), lesion.end + lesion.healthy_diameter);
  const double proximal = diameterAt(before);
  const double distal = diameterAt(after);

  LesionReport report;
  report.stenosis = -1e300;
  for (int k = 0; k <= kSections; ++k)
  {
    const double arc = lesion.begin + (lesion.end - lesion.begin) * k / kSections;
    const double t = (arc - before) / (after - before);
    const double reference = (1.0 - t) * proximal + t * distal;
    const double diameter = diameterAt(arc);
    if (1.0 - diameter / reference <= report.stenosis)
      continue;
    report.stenosis = 1.0 - diameter / reference;
    report.minimal_diameter = diameter;
    report.reference_diameter = reference;
  }
  if (stent == nullptr || stent->axis.size() < 2)
    return report;
  report.stented = true;
  const double first = axis.nearest(stent->axis.front()).arc;
  const double last = axis.nearest(stent->axis.back()).arc;
  const double covered = std::min(std::max(first, last), lesion.end) - std::max(std::min(first, last), lesion.begin);
  report.coverage = std::clamp(covered / (lesion.end - lesion.begin), 0.0, 1.0);
  report.placement_error = 0.5 * (first + last) - lesion.middle;
  report.apposition = apposition(wall, *stent);
  return report;
}

}  // namespace endovascular_sim::intervention
