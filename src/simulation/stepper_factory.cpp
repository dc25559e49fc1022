#include "simulation/stepper_factory.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "rod/kkt/kkt_stepper.h"
#include "rod/mixed/mixed_stepper.h"
#include "rod/paper/paper_stepper.h"
#include "vessel/centreline/centreline_curvature.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kCorrected = 4.0;  // times the tolerated strain: what turns by more is linearised anew

constexpr double kLeastClearance = 20e-6;  // m
constexpr double kRoomShare = 0.9;         // of what the vessel leaves to the wire in the introducer's mouth

constexpr double kSamplingPeriod = 10e-3;  // s between two looks at the wire's shape

rod::EndHold hold(scene::EndCondition condition)
{
  switch (condition)
  {
    case scene::EndCondition::kPinned:
      return rod::EndHold::kPinned;
    case scene::EndCondition::kClamped:
      return rod::EndHold::kClamped;
    case scene::EndCondition::kFree:
      break;
  }
  return rod::EndHold::kFree;
}

/** The introducer is narrower than the vessel that it lies in. */
rod::Boundary boundaryOf(const scene::Scene& scene, const scene::EntryPose& entry)
{
  rod::Boundary boundary;
  boundary.introducer = scene.introducer;
  boundary.origin = entry.position;
  boundary.direction = entry.direction;
  boundary.director = entry.d1;
  boundary.guide_length = scene.solver.guide_length;
  double radius = 0.0;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    for (const rod::Section& section : driven.instrument.wire.sections)
      radius = std::max(radius, section.radius);
  boundary.sheath_clearance = std::max(kLeastClearance, kRoomShare * (entry.room - radius));
  boundary.proximal = hold(scene.proximal_end);
  boundary.distal = hold(scene.distal_end);
  boundary.distal_twist_held = scene.distal.twist_held;
  return boundary;
}

/** The nodes are those of the longest instrument. */
const rod::Wire& longestWire(const scene::Scene& scene)
{
  return std::max_element(scene.instruments.begin(), scene.instruments.end(),
                          [](const scene::DrivenInstrument& a, const scene::DrivenInstrument& b)
                          { return a.instrument.wire.length() < b.instrument.wire.length(); })
      ->instrument.wire;
}

std::uint64_t stepsIn(double seconds, const scene::Scene& scene)
{
  return static_cast<std::uint64_t>(std::max(1.0, std::round(seconds / scene.solver.time_step)));
}

bool isStill(const scene::DriveProfile& profile)
{
  return profile.points.empty() && profile.amplitude == 0.0;
}

/** Only `kkt` moves a held far end, or holds its twist. */
void checkFarEnd(const scene::Scene& scene)
{
  const scene::DistalScene& distal = scene.distal;
  if (scene.solver.scheme == "kkt" ||
      (!distal.twist_held && isStill(distal.displacement) && isStill(distal.tilt) && isStill(distal.rotation)))
    return;
  throw InputError(scene.file, "solver.scheme",
                   "'" + scene.solver.scheme + "' does not move a far end or hold its twist; use kkt");
}

std::unique_ptr<rod::Stepper> makeMixedStepper(const scene::Scene& scene, rod::Discretisation nodes,
                                               const rod::Boundary& boundary, const rod::Environment& environment,
                                               const rod::StepperSettings& settings)
{
  const rod::Wire& wire = scene.instruments.front().instrument.wire;
  const auto refuse = [&scene](const std::string& why)
  { throw InputError(scene.file, "solver.scheme", "'mixed' does not simulate " + why + "; use kkt"); };
  for (const scene::PointLoad& load : scene.loads.point_loads)
    if (load.torque != 0.0 && scene.distal_end == scene::EndCondition::kClamped)
      refuse("a torque at a clamped tip");
  return std::make_unique<rod::MixedStepper>(wire, std::move(nodes), boundary, environment, settings);
}

}  // namespace

std::uint64_t samplingInterval(const scene::Scene& scene)
{
  return stepsIn(kSamplingPeriod, scene);
}

std::unique_ptr<rod::AdaptiveSampling> makeSampling(const scene::Scene& scene, const scene::EntryPose& entry,
                                                    const vessel::CentrelineTree* centreline)
{
  if (scene.sampling.kind != scene::SamplingKind::kAdaptive)
    return nullptr;
  rod::SamplingSettings settings;
  settings.min_edge = scene.sampling.min_edge;
  settings.max_edge = scene.sampling.max_edge;
  settings.turn_per_edge = scene.sampling.turn_per_edge;
  settings.min_age = static_cast<int>(stepsIn(scene.sampling.min_age, scene) / samplingInterval(scene));
  rod::CurvatureAhead ahead;
  if (centreline != nullptr && !centreline->branches.empty())
    ahead = [curvature = vessel::CentrelineCurvature(*centreline)](const Eigen::Vector3d& place)
    { return curvature.at(place); };
  return std::make_unique<rod::AdaptiveSampling>(longestWire(scene), boundaryOf(scene, entry), settings, ahead);
}

std::unique_ptr<rod::Stepper> makeStepper(const scene::Scene& scene, const scene::EntryPose& entry,
                                          const rod::AdaptiveSampling* sampling)
{
  checkFarEnd(scene);
  rod::Environment environment;
  environment.gravity = scene.loads.gravity;
  environment.fluid_density = scene.loads.fluid_density;
  environment.drag_coefficient = scene.loads.drag_coefficient;
  environment.damping = scene.loads.damping;
  rod::StepperSettings settings;
  settings.linear_solver = scene.solver.linear_solver;
  settings.max_iterations = scene.solver.max_iterations;
  settings.strain_tolerance = scene.solver.strain_tolerance;
  settings.corrected_strain = kCorrected * scene.solver.strain_tolerance;
  settings.contact_stiffness = scene.solver.contact_stiffness;
  settings.contact_margin = scene.solver.contact_margin;
  const rod::Boundary boundary = boundaryOf(scene, entry);
  rod::Discretisation wire = sampling != nullptr ? sampling->discretisation()
                                                 : rod::discretiseUniformly(longestWire(scene), scene.sampling.nodes);
  if (scene.instruments.size() > 1)
  {
    std::vector<rod::Layer> layers;
    for (const scene::DrivenInstrument& driven : scene.instruments)
      layers.push_back({driven.instrument.wire, driven.friction, driven.fit_load});
    return std::make_unique<rod::KktStepper>(layers, wire.position, boundary, environment, settings);
  }
  if (scene.solver.scheme == "paper")
    return std::make_unique<rod::PaperStepper>(std::move(wire), boundary, environment, settings);
  if (scene.solver.scheme == "mixed")
    return makeMixedStepper(scene, std::move(wire), boundary, environment, settings);
  return std::make_unique<rod::KktStepper>(std::move(wire), boundary, environment, settings);
}

}  // namespace endovascular_sim::simulation
