#pragma once

#include <limits>
#include <string>

#include <Eigen/Core>

#include "contact/wall/wall_law.h"
#include "scene/model/scene.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::scene
{

/** Whether a vessel's centreline is wanted: extracting one from a mesh takes seconds. */
enum class CentrelineUse
{
  kIfCheap,   ///< only where it comes for nothing (tube, anatomy) or the entry asks for it
  kRequired,  ///< always
};

/** What a scene needs: adaptive sampling looks ahead along the centreline. */
CentrelineUse centrelineUse(const Scene& scene);

/** Stiffness and friction of a scene's wall. */
contact::WallLaw wallLaw(const VesselScene& scene);

/** Reads or makes the vessel of a scene: unit, check and repair, transform, smoothing, lesions.
 *  @param origin the scene's file, for errors
 *  @throws InputError when the mesh or the anatomy is refused */
vessel::Vessel buildVessel(const VesselScene& scene, const EntryScene& entry, const std::string& origin,
                           CentrelineUse centreline = CentrelineUse::kIfCheap);

/** Where the wire enters, and how it is turned there. */
struct EntryPose
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     ///< patient frame [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();   ///< unit vector into the vessel
  Eigen::Vector3d d1 = Eigen::Vector3d::UnitX();          ///< unit, at right angles to direction
  double room = std::numeric_limits<double>::infinity();  ///< from the position to the wall [m]
};

/** Distance from a place to the mesh, by all its triangles [m]. */
double roomAround(const Eigen::Vector3d& place, const geometry::TriangleMesh& mesh);

/** The entry without a vessel: the scene's pose, d1 made orthogonal.
 *  @throws InputError when up and direction are parallel */
EntryPose resolveEntry(const EntryScene& entry, const std::string& origin = "scene");

/** The entry in a vessel: the scene's pose, or a centreline end moved inward by the offset along the centreline.
 *  @throws InputError when the named end does not exist (listing those that do) or the entry is not inside */
EntryPose resolveEntry(const EntryScene& entry, const vessel::Vessel& vessel, const std::string& origin = "scene");

/** The same for a scene whose instruments begin there.
 *  @throws InputError as above, and where an instrument, which begins straight, would begin in the wall */
EntryPose resolveStart(const Scene& scene, const vessel::Vessel& vessel);

}  // namespace endovascular_sim::scene
