#include "scene/scene_vessel.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "contact/wall/smooth_wall.h"
#include "geometry/closest_point_on_triangle.h"
#include "geometry/loop_subdivision.h"
#include "geometry/mesh_distance.h"
#include "scene/schema/scene_schema.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/anatomy/mesh_centreline.h"
#include "vessel/anatomy/tube.h"
#include "vessel/centreline/centreline_extraction.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/lesion/add_lesions.h"
#include "vessel/repair/lumen_check.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"
#include "vessel/repair/mesh_size.h"

namespace endovascular_sim::scene
{
namespace
{

vessel::Vessel vesselFromMeshFile(const VesselScene& scene, const ProgressReport& progress)
{
  vessel::Vessel vessel;
  vessel.source = scene.mesh;
  vessel::MeshRemarks remarks;
  vessel.mesh = vessel::readMesh(scene.mesh, scene.unit, progress, &remarks);
  vessel.notes = std::move(remarks.notes);
  vessel.warnings = std::move(remarks.warnings);
  reportProgress(progress, "check of the mesh");
  const vessel::MeshReport report = vessel::checkMesh(vessel.mesh);
  vessel::requirePlausibleSize(vessel.mesh, report, scene.unit, scene.mesh);
  if (const std::string warning = vessel::distanceWarning(report, scene.mesh); !warning.empty())
    vessel.warnings.push_back(warning);
  if (!scene.repair)
    vessel::requireClean(report, scene.mesh);
  else if (!report.clean())
  {
    vessel::RepairedMesh repaired = vessel::repairMesh(std::move(vessel.mesh), scene.mesh, progress);
    vessel.mesh = std::move(repaired.mesh);
    vessel.notes.insert(vessel.notes.end(), repaired.notes.begin(), repaired.notes.end());
  }
  vessel::requireLumen(vessel.mesh, scene.unit, scene.mesh);
  for (Eigen::Vector3d& v : vessel.mesh.vertices)
    v = scene.transform * v;
  if (!scene.centreline.empty())
    vessel.centreline = vessel::readMeshCentreline(scene.centreline, scene.unit, scene.transform, vessel.mesh);
  return vessel;
}

/** Refines a coarse mesh as far as a smooth wall needs it. */
void refineForSmoothWall(vessel::Vessel& vessel)
{
  const std::size_t before = vessel.mesh.triangles.size();
  vessel.mesh = contact::refinedForSmoothWall(std::move(vessel.mesh));
  if (vessel.mesh.triangles.size() != before)
    vessel.notes.push_back("refined from " + std::to_string(before) + " to " +
                           std::to_string(vessel.mesh.triangles.size()) + " triangles for the smooth wall");
}

bool needsCentreline(const EntryScene& entry)
{
  return entry.nearest_centreline_end || !entry.centreline_end.empty();
}

EntryPose poseWithUp(const Eigen::Vector3d& position, const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                     const std::string& origin)
{
  const Eigen::Vector3d across = up - up.dot(direction) / direction.squaredNorm() * direction;
  if (!(across.norm() > 1e-6 * up.norm()))
    throw InputError(origin, "entry.up", "must not be parallel to the entry's direction; give a direction across it");
  // A unit vector is not normalised again, which retains its bits.
  const bool is_unit = std::abs(direction.squaredNorm() - 1.0) < 1e-12;
  return {position, is_unit ? direction : Eigen::Vector3d(direction.normalized()), across.normalized()};
}

const vessel::CentrelineEnd& nearestEnd(const std::vector<vessel::CentrelineEnd>& ends, const Eigen::Vector3d& point)
{
  const vessel::CentrelineEnd* nearest = &ends.front();
  for (const vessel::CentrelineEnd& end : ends)
    if ((end.position - point).norm() < (nearest->position - point).norm())
      nearest = &end;
  return *nearest;
}

const vessel::CentrelineEnd& namedEnd(const std::vector<vessel::CentrelineEnd>& ends, const vessel::Vessel& vessel,
                                      const std::string& name, const std::string& origin)
{
  const vessel::CentrelineEnd* found = nullptr;
  std::string names;
  for (const vessel::CentrelineEnd& end : ends)
  {
    const std::string& branch = vessel.centreline.branches[static_cast<std::size_t>(end.branch)].name;
    names += (names.empty() ? "" : ", ") + branch;
    if (branch == name)
      found = &end;  // of the two ends of the root branch, the distal one is listed last
  }
  if (found == nullptr)
    throw InputError(origin, "entry.centreline_end",
                     "unknown centreline end \"" + name + "\" in " + vessel.source + "; known: " + names);
  return *found;
}

/** Entry pose on the centreline, at a distance from one of its ends, with the inward tangent. */
EntryPose poseAtEnd(const vessel::CentrelineEnd& end, const vessel::CentrelineTree& tree, const EntryScene& entry,
                    const std::string& origin)
{
  const vessel::CentrelineBranch& branch = tree.branches[static_cast<std::size_t>(end.branch)];
  const std::size_t n = branch.points.size();
  const bool at_front = end.position == branch.points.front();
  const auto at = [&](std::size_t k) { return branch.points[at_front ? k : n - 1 - k]; };
  double left = entry.offset;
  std::size_t k = 0;
  while (k + 1 < n && left >= (at(k + 1) - at(k)).norm())
    left -= (at(k + 1) - at(k)).norm(), ++k;
  if (k + 1 >= n)
    throw InputError(origin, "entry.offset", "is longer than the branch \"" + branch.name + "\"; give a smaller one");
  Eigen::Vector3d direction = end.inward;
  if (entry.offset > 0.0)
    direction = (at(k + 1) - at(k)).normalized();
  const Eigen::Vector3d position = at(k) + left * (at(k + 1) - at(k)).normalized();

  // The default `up` may be parallel to the tangent of the centreline.
  Eigen::Vector3d up = entry.up;
  if (up.normalized().cross(direction).norm() < 1e-3)
    up = direction.unitOrthogonal();
  return poseWithUp(position, direction, up, origin);
}

void requireInside(const EntryPose& pose, const vessel::Vessel& vessel, const std::string& origin)
{
  if (geometry::windingNumber(vessel.mesh, pose.position) > 0.5)
    return;
  const geometry::ClosestPoint wall = geometry::MeshDistance(vessel.mesh).closest(pose.position);
  const std::string distance = formatted("%.3g mm", 1e3 * wall.distance);
  throw InputError(origin, "entry.position",
                   vessel::formatLocation(pose.position) + " is not inside the vessel: it lies " + distance +
                       " outside the wall, with nearest point " + vessel::formatLocation(wall.point) +
                       "; move it inward, or use nearest_centreline_end: true");
}

}  // namespace

CentrelineUse centrelineUse(const Scene& scene)
{
  const bool required = scene.sampling.kind == SamplingKind::kAdaptive || scene.flow || scene.motion;
  return required ? CentrelineUse::kRequired : CentrelineUse::kIfCheap;
}

contact::WallLaw wallLaw(const VesselScene& scene)
{
  return {scene.wall, scene.stiffness, scene.friction, scene.friction_regions};
}

vessel::Vessel buildVessel(const VesselScene& scene, const EntryScene& entry, const std::string& origin,
                           CentrelineUse centreline, const ProgressReport& progress)
{
  vessel::Vessel vessel;
  if (scene.tube)
  {
    const EntryPose start = resolveEntry(entry, origin);
    vessel::TubeShape shape = *scene.tube;
    shape.position = start.position;
    shape.direction = start.direction;
    shape.up = start.d1;
    vessel.source = "tube";
    vessel.mesh = vessel::tubeMesh(shape);
    vessel.centreline = vessel::tubeCentreline(shape);
  }
  else if (!scene.anatomy.empty())
    vessel = vessel::loadAnatomy(scene.anatomy);
  else
    vessel = vesselFromMeshFile(scene, progress);

  if (scene.smoothing > 0)
  {
    reportProgress(progress, "subdivision of the mesh");
    vessel.mesh = geometry::loopSubdivision(std::move(vessel.mesh), scene.smoothing);
    vessel.notes.push_back("smoothed by " + std::to_string(scene.smoothing) + " Loop subdivisions");
  }
  const bool smooth = scene.wall == contact::WallShape::kSmooth;
  if (smooth && scene.lesions.empty())
    refineForSmoothWall(vessel);
  const bool required = centreline == CentrelineUse::kRequired || needsCentreline(entry) || !scene.lesions.empty();
  if (required && vessel.centreline.branches.empty())
    vessel.centreline = vessel::extractCentreline(vessel.mesh, progress);
  vessel::addLesions(vessel, scene.lesions, origin, progress);
  if (smooth && !scene.lesions.empty())
    refineForSmoothWall(vessel);
  return vessel;
}

double distanceToWall(const Eigen::Vector3d& point, const geometry::TriangleMesh& mesh)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles)
    nearest = std::min(
        nearest,
        (geometry::closestPointOnTriangle(point, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).point -
         point)
            .norm());
  return nearest;
}

EntryPose resolveEntry(const EntryScene& entry, const std::string& origin)
{
  return poseWithUp(entry.position, entry.direction, entry.up, origin);
}

EntryPose resolveEntry(const EntryScene& entry, const vessel::Vessel& vessel, const std::string& origin)
{
  EntryPose pose;
  if (needsCentreline(entry))
  {
    const std::vector<vessel::CentrelineEnd> ends = vessel::centrelineEnds(vessel.centreline);
    if (ends.empty())
      throw InputError(origin, "entry", "the vessel's centreline has no ends; give position and direction");
    const vessel::CentrelineEnd& end = entry.nearest_centreline_end
                                           ? nearestEnd(ends, entry.position)
                                           : namedEnd(ends, vessel, entry.centreline_end, origin);
    pose = poseAtEnd(end, vessel.centreline, entry, origin);
  }
  else
    pose = resolveEntry(entry, origin);
  requireInside(pose, vessel, origin);
  pose.wall_distance = distanceToWall(pose.position, vessel.mesh);
  return pose;
}

EntryPose resolveStart(const Scene& scene, const vessel::Vessel& vessel)
{
  EntryPose pose = resolveEntry(scene.entry, vessel, scene.file);
  const bool may_meet_wall =
      scene.introducer && std::any_of(scene.instruments.begin(), scene.instruments.end(),
                                      [&pose](const DrivenInstrument& driven)
                                      { return driven.drive.insertionAt(0.0) > pose.wall_distance; });
  if (may_meet_wall)
    requireFreeStart(scene, freeLength(pose, vessel));
  return pose;
}

double freeLength(const EntryPose& entry, const vessel::Vessel& vessel)
{
  const double hit = geometry::MeshDistance(vessel.mesh).rayHit(entry.position, entry.direction);
  return hit < 0.0 ? std::numeric_limits<double>::infinity() : hit;
}

void requireFreeStart(const Scene& scene, double free_length)
{
  for (std::size_t k = 0; scene.introducer && k < scene.instruments.size(); ++k)
  {
    if (scene.instruments[k].drive.insertionAt(0.0) < free_length)
      continue;
    const std::string limit = formatted("%.3g m", free_length);
    throw InputError(scene.file, drivePath(scene, k) + "drive.initial_insertion",
                     "makes the initially straight instrument penetrate the wall; must be less than " +
                         std::string(limit) + " along entry.direction from entry.position");
  }
}

}  // namespace endovascular_sim::scene
