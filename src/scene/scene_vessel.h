#pragma once

#include <limits>
#include <string>

#include <Eigen/Core>

#include "common/progress.h"
#include "contact/wall/wall_law.h"
#include "scene/model/scene.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::scene
{

/** Requirement of a centreline. Its extraction from a mesh takes seconds. */
enum class CentrelineUse
{
  kIfCheap,   ///< only if no extraction is needed (tube, anatomy), or if the entry or the lesions require it
  kRequired,  ///< always
};

/** Centreline requirement of a scene: adaptive sampling uses the centreline ahead of the tip. */
CentrelineUse centrelineUse(const Scene& scene);

/** Stiffness and friction of a scene's wall. */
contact::WallLaw wallLaw(const VesselScene& scene);

/** Loads or generates the vessel of a scene: unit, validation and repair, transform, smoothing, lesions.
 *  @param origin scene file, for errors
 *  @param progress receives the progress of large meshes
 *  @throws InputError if the mesh or the anatomy is invalid */
vessel::Vessel buildVessel(const VesselScene& scene, const EntryScene& entry, const std::string& origin,
                           CentrelineUse centreline = CentrelineUse::kIfCheap, const ProgressReport& progress = {});

/** Pose of the wire at the entry into the vessel. */
struct EntryPose
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();              ///< position in the patient frame [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();            ///< unit vector into the vessel
  Eigen::Vector3d d1 = Eigen::Vector3d::UnitX();                   ///< material director, unit, normal to direction
  double wall_distance = std::numeric_limits<double>::infinity();  ///< distance from the position to the wall [m]
};

/** Distance from a point to the mesh by brute force over all triangles [m]. */
double distanceToWall(const Eigen::Vector3d& point, const geometry::TriangleMesh& mesh);

/** Entry pose without a vessel: pose of the scene with d1 made orthogonal to the direction.
 *  @throws InputError if up and direction are parallel */
EntryPose resolveEntry(const EntryScene& entry, const std::string& origin = "scene");

/** Entry pose in a vessel: pose of the scene, or a centreline end moved inward along the centreline by the offset.
 *  @throws InputError if the named end does not exist (listing the existing ones) or the entry is outside the vessel */
EntryPose resolveEntry(const EntryScene& entry, const vessel::Vessel& vessel, const std::string& origin = "scene");

/** Entry pose of a scene, with a check of the initial insertions. Instruments are straight at the start.
 *  @throws InputError as resolveEntry(), and if an instrument would penetrate the wall at the start */
EntryPose resolveStart(const Scene& scene, const vessel::Vessel& vessel);

/** Length from an entry to the wall along its direction; infinite where the direction meets no wall [m]. */
double freeLength(const EntryPose& entry, const vessel::Vessel& vessel);

/** Checks the initial insertions of a scene with an introducer.
 *  @param free_length freeLength() of its entry [m]
 *  @throws InputError if an instrument would penetrate the wall at the start */
void requireFreeStart(const Scene& scene, double free_length);

}  // namespace endovascular_sim::scene
