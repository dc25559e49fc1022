#include <cmath>

#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

// Words of rod::EndHold, in the order of the enumerators, and of the twist.
const std::vector<std::string> kEndConditions = {"free", "pinned", "clamped"};
const std::vector<std::string> kTwists = {"free", "held"};

/** Rejects a profile that is not zero at time 0. The wire is straight at the start. */
void requireZeroStart(const yaml::Fields& fields, const std::string& key, const DriveProfile& profile)
{
  if (profile.at(0.0) != 0.0)
    fields.reject(key, "is not 0 at time 0, but the wire is straight at the start; start the profile at [0, 0]");
}

void checkDistalEnd(yaml::Fields& fields, const Scene& scene)
{
  const DistalScene& distal = scene.distal;
  const bool clamped = scene.distal_end == rod::EndHold::kClamped;
  if (distal.twist_held && !clamped)
    fields.reject("twist", "can be held by a clamp only; set hold: clamped, or twist: free");
  if (!distal.displacement.isTrivial() && scene.distal_end == rod::EndHold::kFree)
    fields.reject("displacement", "requires a held end; set hold: pinned or hold: clamped");
  if (!distal.tilt.isTrivial() && !clamped)
    fields.reject("tilt", "requires a held direction; set hold: clamped");
  if (!distal.rotation.isTrivial() && !distal.twist_held)
    fields.reject("rotation", "requires a held twist; set hold: clamped and twist: held");
  if (!distal.tilt.isTrivial() && distal.tilt_axis.isZero())
    fields.reject("tilt.axis", "missing; give the axis about which the clamp tilts, e.g. [0, 0, 1]");
  requireZeroStart(fields, "displacement", distal.displacement);
  requireZeroStart(fields, "tilt", distal.tilt);
}

void visitDistalEnd(yaml::Fields& fields, Scene& scene)
{
  DistalScene& distal = scene.distal;
  fields.option("hold", scene.distal_end, kEndConditions, Need::kRequired);
  int twist = distal.twist_held ? 1 : 0;
  fields.choice("twist", twist, kTwists);
  distal.twist_held = twist == 1;
  fields.map("displacement",
             [&distal](yaml::Fields& motion)
             {
               visitProfile(motion, distal.displacement, quantities::kDisplacement);
               motion.vector3("direction", distal.direction, quantities::kDirection);
             });
  fields.map("tilt",
             [&distal](yaml::Fields& motion)
             {
               visitProfile(motion, distal.tilt, quantities::kAngle);
               motion.vector3("axis", distal.tilt_axis, quantities::kDirection);
             });
  fields.map("rotation",
             [&distal](yaml::Fields& motion) { visitProfile(motion, distal.rotation, quantities::kRotation); });
  if (fields.reading())
    checkDistalEnd(fields, scene);
}

/** True if the vessel, the wire or a load bends an initially straight bench wire. */
bool hasBendingCause(const Scene& scene, const Eigen::Vector3d& along)
{
  bool bent = scene.vessel.has_value() || !scene.distal.tilt.isTrivial() ||
              scene.instruments.front().instrument.wire.curvedTipLength() > 0.0 ||
              !scene.loads.gravity.cross(along).isZero(0.0);
  for (const PointLoad& load : scene.loads.point_loads)
    bent = bent || !load.force.cross(along).isZero(0.0);
  return bent;
}

/** Rejects a displacement that would stretch the inextensible wire, or that compresses a perfectly straight one. The
 *  buckling direction of a perfectly straight wire is undefined. */
void checkDisplacement(const yaml::Fields& fields, const Scene& scene)
{
  const double length = scene.longest();
  const Eigen::Vector3d along = scene.entry.direction.normalized();
  const Eigen::Vector3d direction = scene.distal.direction.isZero() ? along : scene.distal.direction.normalized();
  const auto [low, high] = bounds(scene.distal.displacement);
  for (const double value : {low, high})
    if ((length * along + value * direction).norm() > length + 1e-9)
      fields.reject("distal_end.displacement",
                    "would stretch the wire; keep its ends no further apart than its length, " +
                        std::to_string(length) + " m; negative values compress it");
  if (direction.cross(along).isZero(1e-9) && !hasBendingCause(scene, along))
    fields.reject("distal_end.displacement",
                  "compresses a perfectly straight wire, whose buckling direction is undefined; add "
                  "loads.gravity, or a small force in loads.point_loads");
}

}  // namespace

void visitEnds(yaml::Fields& fields, Scene& scene)
{
  fields.option("proximal_end", scene.proximal_end, kEndConditions);
  if (fields.reading() ? fields.hasMap("distal_end") : scene.distal.isDriven())
    fields.map("distal_end", [&scene](yaml::Fields& end) { visitDistalEnd(end, scene); });
  else
    fields.option("distal_end", scene.distal_end, kEndConditions);
}

void checkEnds(const yaml::Fields& fields, const Scene& scene)
{
  if (scene.introducer && scene.distal_end != rod::EndHold::kFree && !scene.solver.traits().holds_inserted_end)
    fields.reject("distal_end",
                  "scheme '" + scene.solver.scheme +
                      "' does not hold a distal end together with an introducer; set distal_end: free, or "
                      "solver.scheme: kkt");
  if (scene.distal.isDriven() && !scene.solver.traits().moves_distal_end)
    fields.reject("solver.scheme",
                  "'" + scene.solver.scheme + "' does not move a distal end or hold its twist; use kkt");
  if (scene.distal_end == rod::EndHold::kClamped && !scene.solver.traits().clamped_tip_torque)
    for (const PointLoad& load : scene.loads.point_loads)
      if (load.torque != 0.0)
        fields.reject("solver.scheme",
                      "'" + scene.solver.scheme + "' does not simulate a torque at a clamped tip; use kkt");
  if (scene.distal.twist_held)
    for (std::size_t k = 0; k < scene.loads.point_loads.size(); ++k)
      if (scene.loads.point_loads[k].torque != 0.0)
        fields.reject("loads.point_loads." + std::to_string(k) + ".torque",
                      "acts on a tip whose twist is held; remove it, or set distal_end.twist: free");
  const bool entry_known = scene.entry.centreline_end.empty() && !scene.entry.nearest_centreline_end;
  if (!scene.introducer && entry_known && !scene.distal.displacement.isTrivial())
    checkDisplacement(fields, scene);
}

}  // namespace endovascular_sim::scene
