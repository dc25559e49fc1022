#include <algorithm>
#include <cmath>
#include <string>

#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

constexpr double kTouching = 1e-9;  // m, tolerance of a roller that touches the wire at the start

void visitRoller(yaml::Fields& fields, RollerScene& roller)
{
  fields.vector3("position", roller.position, quantities::kPosition, Need::kRequired);
  fields.vector3("axis", roller.axis, quantities::kDirection);
  fields.number("radius", roller.radius, quantities::kRollerRadius, Range::positive(), Need::kRequired);
  fields.number("friction", roller.friction, quantities::kFriction, Range::nonNegative());
  fields.map("displacement",
             [&roller](yaml::Fields& motion)
             {
               visitProfile(motion, roller.displacement, quantities::kDisplacement);
               motion.vector3("direction", roller.direction, quantities::kDirection);
             });
  if (!fields.reading())
    return;
  if (roller.axis.isZero())
    fields.reject("axis", "has no direction; give a vector along the roller, e.g. [0, 0, 1]");
  roller.axis.normalize();
  if (!roller.displacement.isTrivial() && roller.direction.isZero())
    fields.reject("displacement.direction", "missing; give the direction of the displacement, e.g. [0, -1, 0]");
  if (!roller.direction.isZero())
    roller.direction.normalize();
}

/** Least distance of a segment from the axis of a roller [m]. */
double distanceFromAxis(const RollerScene& roller, const Eigen::Vector3d& axis_point, const Eigen::Vector3d& begin,
                        const Eigen::Vector3d& end)
{
  const auto across = [&roller](const Eigen::Vector3d& v) -> Eigen::Vector3d
  { return v - roller.axis.dot(v) * roller.axis; };
  const Eigen::Vector3d from = across(begin - axis_point);
  const Eigen::Vector3d along = across(end - begin);
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp(-from.dot(along) / squared, 0.0, 1.0) : 0.0;
  return (from + t * along).norm();
}

/** Largest radius of a wire [m]. */
double largestRadius(const rod::Wire& wire)
{
  double largest = 0.0;
  for (const rod::Section& section : wire.sections)
    largest = std::max(largest, section.radius);
  return largest;
}

}  // namespace

void visitRollers(yaml::Fields& fields, Scene& scene)
{
  fields.list(
      "rollers", scene.rollers.size(), [&scene](std::size_t size) { scene.rollers.resize(size); },
      [&scene](yaml::Fields& roller, std::size_t k) { visitRoller(roller, scene.rollers[k]); });
}

void checkRollers(const yaml::Fields& fields, const Scene& scene)
{
  if (scene.rollers.empty())
    return;
  if (scene.vessel)
    fields.reject("rollers", "stand in place of a vessel; set vessel: none, or remove the rollers");
  if (scene.solver.scheme != "kkt")
    fields.reject("solver.scheme", "'" + scene.solver.scheme + "' knows no rollers; use kkt");
  const DrivenInstrument& driven = scene.instruments.front();
  const Eigen::Vector3d along = scene.entry.direction.normalized();
  const double inserted = scene.introducer ? std::max(0.0, driven.drive.insertionAt(0.0)) : scene.longest();
  const double radius = largestRadius(driven.instrument.wire);
  for (std::size_t k = 0; k < scene.rollers.size(); ++k)
  {
    const RollerScene& roller = scene.rollers[k];
    const double distance =
        distanceFromAxis(roller, roller.positionAt(0.0), scene.entry.position, scene.entry.position + inserted * along);
    if (distance < roller.radius + radius - kTouching)
      fields.reject("rollers." + std::to_string(k) + ".position",
                    "is " + std::to_string(distance) +
                        " m from the axis of the wire, which is straight at the start; must be at least the sum of "
                        "the radii, " +
                        std::to_string(roller.radius + radius) + " m");
  }
}

}  // namespace endovascular_sim::scene
