#include "fluoroscopy/projection/moving_vessel.h"

#include <utility>

#include "fluoroscopy/projection/vessel_projection.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

bool equal(const motion::Fade& a, const motion::Fade& b)
{
  return a.centre == b.centre && a.reach == b.reach;
}

void addTriangles(const std::vector<Eigen::Vector3i>& triangles, const std::vector<Corner>& corners,
                  const XRayGeometry& geometry, std::vector<double>& sum)
{
  for (const Eigen::Vector3i& t : triangles)
    addTriangle(corners[static_cast<std::size_t>(t[0])], corners[static_cast<std::size_t>(t[1])],
                corners[static_cast<std::size_t>(t[2])], geometry.pose().source_to_detector, geometry.pixels(), sum);
}

}  // namespace

void MovingVessel::setMesh(geometry::TriangleMesh mesh)
{
  mesh_ = std::move(mesh);
  fade_.reset();
  pose_.reset();
  moving_.clear();
}

void MovingVessel::divide(const motion::Fade& fade)
{
  if (fade_ && equal(*fade_, fade))
    return;
  fade_ = fade;
  pose_.reset();
  positions_ = mesh_.vertices;
  vertices_.clear(), rest_.clear(), moving_.clear(), fixed_.clear();
  std::vector<char> moves(mesh_.vertices.size(), 0);
  for (std::size_t k = 0; k < mesh_.vertices.size(); ++k)
    if ((mesh_.vertices[k] - fade.centre).squaredNorm() < fade.reach * fade.reach)
    {
      moves[k] = 1;
      vertices_.push_back(static_cast<int>(k));
      rest_.push_back(mesh_.vertices[k]);
    }
  for (const Eigen::Vector3i& t : mesh_.triangles)
  {
    const bool any = moves[static_cast<std::size_t>(t[0])] != 0 || moves[static_cast<std::size_t>(t[1])] != 0 ||
                     moves[static_cast<std::size_t>(t[2])] != 0;
    (any ? moving_ : fixed_).push_back(t);
  }
}

void MovingVessel::projectFixed(const XRayGeometry& geometry)
{
  if (pose_ && *pose_ == geometry.pose())
    return;
  corners_.clear();
  corners_.reserve(mesh_.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh_.vertices)
    corners_.push_back(projectCorner(geometry, vertex));
  const auto side = static_cast<std::size_t>(geometry.pixels());
  fixed_sum_.assign(side * side, 0.0);
  addTriangles(fixed_, corners_, geometry, fixed_sum_);
  pose_ = geometry.pose();
}

void MovingVessel::project(const XRayGeometry& geometry, const motion::MotionMap& map)
{
  if (map.resting())
  {
    lengths_ = vesselPathLength(geometry, mesh_);
    return;
  }
  divide(map.frame().fade);
  projectFixed(geometry);
  map.positions(rest_, moved_);
  for (std::size_t k = 0; k < vertices_.size(); ++k)
  {
    corners_[static_cast<std::size_t>(vertices_[k])] = projectCorner(geometry, moved_[k]);
    positions_[static_cast<std::size_t>(vertices_[k])] = moved_[k];
  }
  lengths_ = fixed_sum_;
  addTriangles(moving_, corners_, geometry, lengths_);
  depthsToLengths(geometry, lengths_);
}

}  // namespace endovascular_sim::fluoroscopy
