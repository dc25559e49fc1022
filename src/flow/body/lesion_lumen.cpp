#include "flow/body/lesion_lumen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/closest_point_on_triangle.h"
#include "geometry/polyline.h"
#include "vessel/centreline/lumen_section.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kSpacing = 5e-4;       // between two cross-sections [m]
constexpr double kTangentReach = 1e-3;  // half length of the chord that defines the normal of a section [m]
constexpr double kReach = 1.5;          // distance of triangles that are picked from a section, in healthy diameters
constexpr double kGap = 1e-12;          // relative gap between two triangles that a ray does not pass
constexpr double kPseudoError = 0.05;   // largest error of pseudoAngle(), in quadrants
constexpr std::size_t kOutside = std::numeric_limits<std::size_t>::max();

double across(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/** Increasing function of the angle, from 0 to 4 for a whole turn, that is equal to it at the axes: of the direction's
 *  point on a square. */
double pseudoAngle(const Eigen::Vector2d& p)
{
  const double along = p.x() / (std::abs(p.x()) + std::abs(p.y()));
  return p.y() >= 0.0 ? 1.0 - along : 3.0 + along;
}

/** Point where an edge crosses a plane, in the plane's coordinates. @param from, to their distances from the plane */
Eigen::Vector2d crossing(const Eigen::Vector2d& a, double from, const Eigen::Vector2d& b, double to)
{
  return a + from / (from - to) * (b - a);
}

/** Shortens the rays that hit a segment. */
void shorten(const std::vector<Eigen::Vector2d>& rays, Eigen::Vector2d a, Eigen::Vector2d b,
             std::vector<double>& reaches)
{
  double turn = across(a, b);
  if (turn < 0.0)
    std::swap(a, b);
  turn = std::abs(turn);
  if (!(turn > 0.0))
    return;
  const std::size_t count = rays.size();
  const double gap_a = -kGap * (std::abs(a.x()) + std::abs(a.y())), gap_b = -kGap * (std::abs(b.x()) + std::abs(b.y()));
  const double first = (pseudoAngle(a) - kPseudoError) * 0.25 * static_cast<double>(count);
  std::size_t k = (static_cast<std::size_t>(first + static_cast<double>(count))) % count;
  std::size_t left = count;
  const auto next = [&]
  {
    k = k + 1 < count ? k + 1 : 0;
    --left;
  };
  while (left > 0 && across(a, rays[k]) < gap_a)
    next();
  const Eigen::Vector2d along = b - a;
  for (; left > 0 && across(a, rays[k]) >= gap_a && across(rays[k], b) >= gap_b; next())
    reaches[k] = std::min(reaches[k], turn / across(rays[k], along));
}

}  // namespace

LesionLumens::LesionLumens(const geometry::TriangleMesh& wall, const vessel::CentrelineTree& centreline,
                           const std::vector<vessel::PlacedLesion>& lesions)
{
  for (int k = 0; k < vessel::kSectionRays; ++k)
  {
    const double angle = k * (2.0 * kPi / vessel::kSectionRays);
    rays_.emplace_back(std::cos(angle), std::sin(angle));
  }
  for (const vessel::PlacedLesion& lesion : lesions)
  {
    const geometry::Polyline axis(centreline.branches[static_cast<std::size_t>(lesion.branch)].points, kTangentReach);
    const int count = std::max(2, static_cast<int>(std::ceil((lesion.end - lesion.begin) / kSpacing)));
    LumenProfile lumen;
    lumen.branch = lesion.branch;
    std::vector<Section> sections;
    for (int k = 0; k <= count; ++k)
    {
      lumen.arcs.push_back(lesion.begin + (lesion.end - lesion.begin) * k / count);
      const geometry::Polyline::Foot foot = axis.normalPlaneFoot(axis.at(lumen.arcs.back()));
      const Eigen::Vector3d u = foot.tangent.unitOrthogonal();
      sections.push_back({foot.point, foot.tangent, u, foot.tangent.cross(u)});
    }
    lumen.areas.resize(lumen.arcs.size());
    lumens_.push_back(std::move(lumen));
    regions_.push_back(regionOf(wall, lesion, std::move(sections)));
  }
}

/** Picks the triangles that are near the sections. */
LesionLumens::Region LesionLumens::regionOf(const geometry::TriangleMesh& wall, const vessel::PlacedLesion& lesion,
                                            std::vector<Section> sections)
{
  const double reach = kReach * lesion.healthy_diameter;
  Eigen::AlignedBox3d around;
  for (const Section& section : sections)
    around.extend(section.centre);
  around.min().array() -= reach;
  around.max().array() += reach;
  Region region;
  std::vector<std::size_t> local(wall.vertices.size(), kOutside);
  for (const Eigen::Vector3i& triangle : wall.triangles)
  {
    const auto corner = [&](int k) -> const Eigen::Vector3d&
    { return wall.vertices[static_cast<std::size_t>(triangle[k])]; };
    Eigen::AlignedBox3d box(corner(0));
    box.extend(corner(1)).extend(corner(2));
    if (!box.intersects(around))
      continue;
    const auto isNear = [&](const Section& section)
    {
      const Eigen::Vector3d point =
          geometry::closestPointOnTriangle(section.centre, corner(0), corner(1), corner(2)).point;
      return (point - section.centre).norm() < reach;
    };
    if (std::none_of(sections.begin(), sections.end(), isNear))
      continue;
    std::array<std::size_t, 3> corners;
    for (int k = 0; k < 3; ++k)
    {
      const auto vertex = static_cast<std::size_t>(triangle[k]);
      if (local[vertex] == kOutside)
      {
        local[vertex] = region.vertices.size();
        region.vertices.push_back(vertex);
        const auto nearest =
            std::min_element(sections.begin(), sections.end(),
                             [&](const Section& a, const Section& b)
                             { return (a.centre - corner(k)).squaredNorm() < (b.centre - corner(k)).squaredNorm(); });
        region.nearest.push_back(static_cast<std::size_t>(nearest - sections.begin()));
      }
      corners[static_cast<std::size_t>(k)] = local[vertex];
    }
    region.corners.push_back(corners);
  }
  region.sections = std::move(sections);
  return region;
}

const std::vector<LumenProfile>& LesionLumens::measure(const std::vector<Eigen::Vector3d>& vertices)
{
  for (std::size_t k = 0; k < regions_.size(); ++k)
    measure(regions_[k], vertices, lumens_[k].areas);
  return lumens_;
}

void LesionLumens::measure(const Region& region, const std::vector<Eigen::Vector3d>& vertices,
                           std::vector<double>& areas)
{
  countSections(region, vertices);
  reaches_.resize(std::max(reaches_.size(), region.sections.size()));
  for (std::size_t k = 0; k < region.sections.size(); ++k)
    reaches_[k].assign(rays_.size(), vessel::kNoHit);
  for (const auto& [a, b, c] : region.corners)
  {
    const auto [low, high] = std::minmax({behind_[a], behind_[b], behind_[c]});
    for (std::size_t k = low; k < high; ++k)
      cut(region.sections[k],
          {&vertices[region.vertices[a]], &vertices[region.vertices[b]], &vertices[region.vertices[c]]}, reaches_[k]);
  }
  for (std::size_t k = 0; k < region.sections.size(); ++k)
  {
    const double diameter = vessel::equalAreaDiameter(reaches_[k]);
    areas[k] = 0.25 * kPi * diameter * diameter;
  }
}

/** Sections behind each vertex. The planes of neighbouring sections do not cross within the wall. */
void LesionLumens::countSections(const Region& region, const std::vector<Eigen::Vector3d>& vertices)
{
  behind_.resize(std::max(behind_.size(), region.vertices.size()));
  for (std::size_t i = 0; i < region.vertices.size(); ++i)
  {
    const Eigen::Vector3d& point = vertices[region.vertices[i]];
    const auto isBehind = [&](std::size_t k)
    { return (point - region.sections[k].centre).dot(region.sections[k].tangent) >= 0.0; };
    std::size_t behind = region.nearest[i];
    while (behind > 0 && !isBehind(behind - 1))
      --behind;
    while (behind < region.sections.size() && isBehind(behind))
      ++behind;
    behind_[i] = behind;
  }
}

/** Shortens the rays of a section that hit a triangle. */
void LesionLumens::cut(const Section& section, const std::array<const Eigen::Vector3d*, 3>& corners,
                       std::vector<double>& reaches)
{
  std::array<double, 3> heights;
  std::array<Eigen::Vector2d, 3> points;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Eigen::Vector3d from = *corners[k] - section.centre;
    heights[k] = from.dot(section.tangent);
    points[k] = {from.dot(section.u), from.dot(section.v)};
  }
  for (std::size_t k = 0; k < 3; ++k)
  {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const bool is_alone =
        (heights[k] >= 0.0) != (heights[next] >= 0.0) && (heights[k] >= 0.0) != (heights[last] >= 0.0);
    if (is_alone)
      shorten(rays_, crossing(points[k], heights[k], points[next], heights[next]),
              crossing(points[k], heights[k], points[last], heights[last]), reaches);
  }
}

}  // namespace endovascular_sim::flow
