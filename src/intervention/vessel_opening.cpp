#include "intervention/vessel_opening.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/vertex_normals.h"
#include "vessel/centreline/branch_finder.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kStill = 1e-6;  // m: less movement is not told
/** A wall that looks along the balloon or towards it belongs to another vessel, or to a cap: cosine. */
constexpr double kOwnWall = 0.2;

/** Radius of the vessel without its lesions at each point of a branch: across a lesion between its ends'. */
std::vector<double> healthyRadii(const vessel::Vessel& vessel, int branch, const geometry::Polyline& axis)
{
  const std::vector<double> narrowed = vessel.centreline.branches[static_cast<std::size_t>(branch)].radii;
  std::vector<double> radii = narrowed;
  for (const vessel::PlacedLesion& lesion : vessel.lesions)
    for (std::size_t k = 0; k < radii.size(); ++k)
    {
      const double t = (axis.arcs()[k] - lesion.begin) / (lesion.end - lesion.begin);
      if (lesion.branch == branch && t > 0.0 && t < 1.0)
        radii[k] = (1.0 - t) * axis.interpolate(narrowed, lesion.begin) + t * axis.interpolate(narrowed, lesion.end);
    }
  return radii;
}

}  // namespace

VesselOpening::VesselOpening(const vessel::Vessel& vessel, const OpeningLaw& law)
  : law_(law),
    mesh_(vessel.mesh),
    first_(vessel.mesh.vertices),
    normals_(geometry::vertexNormals(vessel.mesh)),
    tree_(first_),
    walls_(first_.size()),
    segment_of_(first_.size(), 0),
    marked_(first_.size(), 0)
{
  std::vector<geometry::Polyline> axes;
  std::vector<std::vector<double>> radii;
  for (const vessel::CentrelineBranch& branch : vessel.centreline.branches)
  {
    axes.emplace_back(branch.points);
    radii.push_back(healthyRadii(vessel, static_cast<int>(radii.size()), axes.back()));
  }
  const vessel::BranchFinder branches(vessel.centreline);
  for (std::size_t v = 0; v < first_.size(); ++v)
  {
    walls_[v].base = first_[v];
    const int nearest = branches.nearest(first_[v]);
    if (nearest < 0)
      continue;
    const auto b = static_cast<std::size_t>(nearest);
    walls_[v].healthy_radius = axes[b].interpolate(radii[b], axes[b].nearest(first_[v]).arc);
  }
}

/** Seen from where the vertex stood when the balloon was empty. */
VesselOpening::Reach VesselOpening::reachOf(const geometry::Polyline& axis, const std::vector<double>& radii,
                                            int vertex) const
{
  const Eigen::Vector3d& base = walls_[static_cast<std::size_t>(vertex)].base;
  const geometry::Polyline::Foot foot = axis.section(base, segment_of_[static_cast<std::size_t>(vertex)]);
  Reach reach;
  const Eigen::Vector3d way = base - foot.point;
  const Eigen::Vector3d across = way - way.dot(foot.tangent) * foot.tangent;
  // Beyond the axis's ends there is no body.
  if (std::abs(way.dot(foot.tangent)) > 1e-9 + 0.05 * across.norm())
    return reach;
  reach.distance = across.norm();
  if (!(reach.distance > 0.0))
    return reach;
  reach.outward = across / reach.distance;
  if (reach.outward.dot(normals_[static_cast<std::size_t>(vertex)]) > kOwnWall)
    reach.radius = axis.interpolate(radii, foot.arc);
  return reach;
}

/** Lists the vertices that a body may reach or that have to be looked after. */
void VesselOpening::findNear(const geometry::Polyline& axis, double widest)
{
  near_ = active_;
  for (int v : near_)
    marked_[static_cast<std::size_t>(v)] = 1;
  const double step = std::max(widest, 1e-4);
  const double reach = std::hypot(widest + farthest_, 0.5 * step) + farthest_;
  const int count = std::max(1, static_cast<int>(std::ceil(axis.length() / step)));
  for (int v : near_)
    segment_of_[static_cast<std::size_t>(v)] = axis.segmentAt(0.5 * axis.length());
  for (int k = 0; k <= count && widest > 0.0; ++k)
  {
    const double arc = axis.length() * k / count;
    const std::size_t segment = axis.segmentAt(arc);
    tree_.within(axis.at(arc), reach,
                 [this, segment](int v)
                 {
                   segment_of_[static_cast<std::size_t>(v)] = segment;
                   if (marked_[static_cast<std::size_t>(v)] == 0)
                   {
                     marked_[static_cast<std::size_t>(v)] = 1;
                     near_.push_back(v);
                   }
                 });
  }
  for (int v : near_)
    marked_[static_cast<std::size_t>(v)] = 0;
  // Along the body, so that those that move together stand together.
  std::sort(near_.begin(), near_.end(), [this](int a, int b) { return placeOf(a) < placeOf(b); });
}

/** @return whether the vertex stands there now */
bool VesselOpening::settle(int vertex, const Eigen::Vector3d& position, std::size_t most)
{
  Eigen::Vector3d& now = mesh_.vertices[static_cast<std::size_t>(vertex)];
  if (!((position - now).norm() > kStill))
    return true;
  if (moved_.indices.size() >= most)
    return false;
  now = position;
  farthest_ = std::max(farthest_, (now - first_[static_cast<std::size_t>(vertex)]).norm());
  moved_.indices.push_back(vertex);
  moved_.positions.push_back(position);
  return true;
}

/** The balloon is empty: where the wall stays is where the next one finds it. */
void VesselOpening::startAnew()
{
  for (int v : active_)
  {
    Wall& wall = walls_[static_cast<std::size_t>(v)];
    wall.base += wall.held.norm() > wall.rest.norm() ? wall.held : wall.rest;
    wall.held.setZero();
    wall.rest.setZero();
    wall.peak = 0.0;
  }
  peak_pressure_ = 0.0;
  empty_ = true;
}

const WallDisplacement& VesselOpening::press(const RoundBody& balloon, double pressure, std::size_t most)
{
  moved_.indices.clear();
  moved_.positions.clear();
  if (pressure <= 0.0)
  {
    if (!empty_)
      startAnew();
    const auto stands = [this, most](int v)
    {
      Wall& wall = walls_[static_cast<std::size_t>(v)];
      wall.active = !settle(v, wall.base, most);
      return !wall.active;
    };
    active_.erase(std::remove_if(active_.begin(), active_.end(), stands), active_.end());
    return moved_;
  }
  empty_ = false;
  peak_pressure_ = std::max(peak_pressure_, pressure);
  const double share =
      std::clamp((peak_pressure_ - law_.first_pressure) / (law_.full_pressure - law_.first_pressure), 0.0, 1.0);
  const geometry::Polyline axis(balloon.axis);
  findNear(axis, *std::max_element(balloon.radii.begin(), balloon.radii.end()));
  // Those that had to wait come first.
  const auto first = std::lower_bound(near_.begin(), near_.end(), next_,
                                      [this](int v, const Place& place) { return placeOf(v) < place; });
  std::rotate(near_.begin(), first, near_.end());
  next_ = Place();
  bool waits = false;
  for (int v : near_)
  {
    Wall& wall = walls_[static_cast<std::size_t>(v)];
    const Reach reach = reachOf(axis, balloon.radii, v);
    const double pushed = share * std::max(0.0, reach.radius - reach.distance);
    if (reach.distance + pushed > wall.peak && pushed > 0.0)
    {
      wall.peak = reach.distance + pushed;
      wall.rest = std::max(0.0, (1.0 - law_.recoil) * wall.peak - reach.distance) * reach.outward;
      if (wall.healthy_radius > 0.0)
        largest_stretch_ = std::max(largest_stretch_, wall.peak / wall.healthy_radius);
    }
    if (pushed > 0.0 && !wall.active)
    {
      wall.active = true;
      active_.push_back(v);
    }
    Eigen::Vector3d shift = pushed > wall.rest.norm() ? Eigen::Vector3d(pushed * reach.outward) : wall.rest;
    if (wall.held.norm() > shift.norm())
      shift = wall.held;
    if (!settle(v, wall.base + shift, most) && !waits)
      next_ = placeOf(v), waits = true;
  }
  return moved_;
}

const WallDisplacement& VesselOpening::press(const BalloonLoad& pressing, std::size_t most)
{
  if (pressing.sleeve)
    hold(*pressing.sleeve);
  return press(pressing.balloon, pressing.balloon.axis.empty() ? 0.0 : pressing.pressure, most);
}

void VesselOpening::hold(const RoundBody& sleeve)
{
  const geometry::Polyline axis(sleeve.axis);
  findNear(axis, *std::max_element(sleeve.radii.begin(), sleeve.radii.end()));
  for (int v : near_)
  {
    Wall& wall = walls_[static_cast<std::size_t>(v)];
    const Reach reach = reachOf(axis, sleeve.radii, v);
    const double outside = reach.radius - reach.distance;
    if (outside > wall.held.norm())
      wall.held = outside * reach.outward;
    if (wall.held.norm() > 0.0 && !wall.active)
    {
      wall.active = true;
      active_.push_back(v);
    }
  }
}

}  // namespace endovascular_sim::intervention
