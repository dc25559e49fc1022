#include "intervention/vessel_dilatation.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/vertex_normals.h"
#include "vessel/centreline/branch_finder.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kStill = 1e-6;       // smallest reported displacement [m]
constexpr double kFollowed = 0.2e-3;  // m, motion and growth of a body before its surroundings are searched again
/** Minimum cosine between a vertex normal and the direction from the balloon's axis. Below it the vertex belongs to
 *  another vessel or to an end cap. */
constexpr double kOwnWall = 0.2;

/** Radius of the vessel without lesions at each point of a branch: interpolated between the ends of each lesion. */
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

VesselDilatation::VesselDilatation(const vessel::Vessel& vessel, const DilatationLaw& law)
  : law_(law),
    mesh_(vessel.mesh),
    initial_vertices_(vessel.mesh.vertices),
    normals_(geometry::vertexNormals(vessel.mesh)),
    tree_(initial_vertices_),
    vertices_(initial_vertices_.size()),
    segment_of_(initial_vertices_.size(), 0),
    marked_(initial_vertices_.size(), 0)
{
  std::vector<geometry::Polyline> axes;
  std::vector<std::vector<double>> radii;
  for (const vessel::CentrelineBranch& branch : vessel.centreline.branches)
  {
    axes.emplace_back(branch.points);
    radii.push_back(healthyRadii(vessel, static_cast<int>(radii.size()), axes.back()));
  }
  const vessel::BranchFinder branches(vessel.centreline);
  for (std::size_t v = 0; v < initial_vertices_.size(); ++v)
  {
    vertices_[v].base = initial_vertices_[v];
    const int nearest = branches.nearest(initial_vertices_[v]);
    if (nearest < 0)
      continue;
    const auto b = static_cast<std::size_t>(nearest);
    vertices_[v].healthy_radius = axes[b].interpolate(radii[b], axes[b].nearest(initial_vertices_[v]).arc);
  }
}

/** Evaluated at the base position of the vertex. */
VesselDilatation::Reach VesselDilatation::reachOf(const geometry::Polyline& axis, const std::vector<double>& radii,
                                                  int vertex) const
{
  const Eigen::Vector3d& base = vertices_[static_cast<std::size_t>(vertex)].base;
  const geometry::Polyline::Foot foot = axis.normalPlaneFoot(base, segment_of_[static_cast<std::size_t>(vertex)]);
  Reach reach;
  const Eigen::Vector3d offset = base - foot.point;
  const Eigen::Vector3d across = offset - offset.dot(foot.tangent) * foot.tangent;
  // The body ends with its axis.
  if (std::abs(offset.dot(foot.tangent)) > 1e-9 + 0.05 * across.norm())
    return reach;
  reach.distance = across.norm();
  if (!(reach.distance > 0.0))
    return reach;
  reach.outward = across / reach.distance;
  if (reach.outward.dot(normals_[static_cast<std::size_t>(vertex)]) > kOwnWall)
    reach.radius = axis.interpolate(radii, foot.arc);
  return reach;
}

/** True where near_ holds all vertices within reach of a body. */
bool VesselDilatation::isFollowed(const std::vector<Eigen::Vector3d>& axis, double widest) const
{
  if (axis.size() != surroundings_.axis.size() || widest > surroundings_.widest + kFollowed ||
      largest_displacement_ > surroundings_.displacement + kFollowed)
    return false;
  for (std::size_t k = 0; k < axis.size(); ++k)
    if ((axis[k] - surroundings_.axis[k]).squaredNorm() > kFollowed * kFollowed)
      return false;
  return true;
}

/** Updates near_ for a body. A search costs more than the motion of the wall. */
void VesselDilatation::follow(const geometry::Polyline& axis, double widest)
{
  if (isFollowed(axis.points(), widest))
    return;
  surroundings_ = {axis.points(), widest, largest_displacement_};
  findNear();
}

/** Collects the active vertices and those within reach of the bodies that surroundings_ stands for. */
void VesselDilatation::findNear()
{
  const geometry::Polyline axis(surroundings_.axis);
  near_ = active_;
  for (int v : near_)
    marked_[static_cast<std::size_t>(v)] = 1;
  const double widest = surroundings_.widest + kFollowed;
  const double displaced = surroundings_.displacement + kFollowed;
  const double step = std::max(widest, 1e-4);
  const double reach = std::hypot(widest + displaced, 0.5 * step) + displaced + kFollowed;
  const int count = std::max(1, static_cast<int>(std::ceil(axis.length() / step)));
  for (int v : near_)
    segment_of_[static_cast<std::size_t>(v)] = axis.segmentAt(0.5 * axis.length());
  for (int k = 0; k <= count; ++k)
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
  // Ordered along the body, so that vertices that move in one call are neighbours.
  std::sort(near_.begin(), near_.end(), [this](int a, int b) { return orderOf(a) < orderOf(b); });
}

/** Moves a vertex, unless the call has moved @p max_vertices already.
 *  @return true if the vertex is at @p position */
bool VesselDilatation::moveVertex(int vertex, const Eigen::Vector3d& position, std::size_t max_vertices)
{
  Eigen::Vector3d& now = mesh_.vertices[static_cast<std::size_t>(vertex)];
  if (!((position - now).norm() > kStill))
    return true;
  if (displacement_.indices.size() >= max_vertices)
    return false;
  now = position;
  largest_displacement_ =
      std::max(largest_displacement_, (now - initial_vertices_[static_cast<std::size_t>(vertex)]).norm());
  displacement_.indices.push_back(vertex);
  displacement_.positions.push_back(position);
  return true;
}

/** Ends an inflation: the remaining displacement becomes the base of the next inflation. */
void VesselDilatation::resetBase()
{
  for (int v : active_)
  {
    VertexState& vertex_state = vertices_[static_cast<std::size_t>(v)];
    vertex_state.base += vertex_state.held.norm() > vertex_state.rest.norm() ? vertex_state.held : vertex_state.rest;
    vertex_state.held.setZero();
    vertex_state.rest.setZero();
    vertex_state.peak = 0.0;
  }
  peak_pressure_ = 0.0;
  empty_ = true;
}

/** Moves the wall of an empty balloon to its base. */
void VesselDilatation::deflate(std::size_t max_vertices)
{
  if (!empty_)
    resetBase();
  const auto isAtRest = [this, max_vertices](int v)
  {
    VertexState& vertex_state = vertices_[static_cast<std::size_t>(v)];
    vertex_state.active = !moveVertex(v, vertex_state.base, max_vertices);
    return !vertex_state.active;
  };
  active_.erase(std::remove_if(active_.begin(), active_.end(), isAtRest), active_.end());
}

/** Updates peak distance, recoil and stretch of a vertex.
 *  @return radial displacement by the balloon [m] */
double VesselDilatation::dilate(int vertex, const Reach& reach, double yield_fraction)
{
  VertexState& vertex_state = vertices_[static_cast<std::size_t>(vertex)];
  const double dilatation = yield_fraction * std::max(0.0, reach.radius - reach.distance);
  if (reach.distance + dilatation > vertex_state.peak && dilatation > 0.0)
  {
    vertex_state.peak = reach.distance + dilatation;
    vertex_state.rest = std::max(0.0, (1.0 - law_.recoil) * vertex_state.peak - reach.distance) * reach.outward;
    if (vertex_state.healthy_radius > 0.0)
      largest_stretch_ = std::max(largest_stretch_, vertex_state.peak / vertex_state.healthy_radius);
  }
  if (dilatation > 0.0 && !vertex_state.active)
  {
    vertex_state.active = true;
    active_.push_back(vertex);
  }
  return dilatation;
}

const WallDisplacement& VesselDilatation::applyLoad(const RoundBody& balloon, double pressure, std::size_t max_vertices)
{
  displacement_.indices.clear();
  displacement_.positions.clear();
  if (pressure <= 0.0)
  {
    deflate(max_vertices);
    return displacement_;
  }
  empty_ = false;
  peak_pressure_ = std::max(peak_pressure_, pressure);
  const double yield_fraction =
      std::clamp((peak_pressure_ - law_.onset_pressure) / (law_.full_pressure - law_.onset_pressure), 0.0, 1.0);
  const geometry::Polyline axis(balloon.axis);
  follow(axis, *std::max_element(balloon.radii.begin(), balloon.radii.end()));
  // Vertices deferred by the previous call come first.
  const auto first =
      static_cast<std::size_t>(std::lower_bound(near_.begin(), near_.end(), next_,
                                                [this](int v, const Order& order) { return orderOf(v) < order; }) -
                               near_.begin());
  next_ = Order();
  bool deferred = false;
  for (std::size_t n = 0; n < near_.size(); ++n)
  {
    const int v = near_[(first + n) % near_.size()];
    const VertexState& vertex_state = vertices_[static_cast<std::size_t>(v)];
    const Reach reach = reachOf(axis, balloon.radii, v);
    const double dilatation = dilate(v, reach, yield_fraction);
    Eigen::Vector3d shift =
        dilatation > vertex_state.rest.norm() ? Eigen::Vector3d(dilatation * reach.outward) : vertex_state.rest;
    if (vertex_state.held.norm() > shift.norm())
      shift = vertex_state.held;
    if (!moveVertex(v, vertex_state.base + shift, max_vertices) && !deferred)
      next_ = orderOf(v), deferred = true;
  }
  return displacement_;
}

const WallDisplacement& VesselDilatation::applyLoad(const BalloonLoad& load, std::size_t max_vertices)
{
  if (load.sleeve)
    placeSleeve(*load.sleeve);
  return applyLoad(load.balloon, load.balloon.axis.empty() ? 0.0 : load.pressure, max_vertices);
}

void VesselDilatation::placeSleeve(const RoundBody& sleeve)
{
  const geometry::Polyline axis(sleeve.axis);
  follow(axis, *std::max_element(sleeve.radii.begin(), sleeve.radii.end()));
  for (int v : near_)
  {
    VertexState& vertex_state = vertices_[static_cast<std::size_t>(v)];
    const Reach reach = reachOf(axis, sleeve.radii, v);
    const double outside = reach.radius - reach.distance;
    if (outside > vertex_state.held.norm())
      vertex_state.held = outside * reach.outward;
    if (vertex_state.held.norm() > 0.0 && !vertex_state.active)
    {
      vertex_state.active = true;
      active_.push_back(v);
    }
  }
}

}  // namespace endovascular_sim::intervention
