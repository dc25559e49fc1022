#include "simulation/stepper_factory.h"

#include <algorithm>
#include <cmath>

#include "rod/kkt/kkt_stepper.h"
#include "rod/mixed/mixed_stepper.h"
#include "rod/paper/paper_stepper.h"
#include "vessel/centreline/centreline_curvature.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kLeastClearance = 20e-6;  // m
constexpr double kClearanceShare = 0.9;    // of the clearance between wire and vessel at the introducer's mouth
constexpr double kDecayPerEdge = 0.9;      // least decay length of the guide over the edges: limits the force's ripple
constexpr double kStraighteningError = 12e-3;  // N, of the force at the mouth by the turn of an edge
constexpr double kSamplingPeriod = 10e-3;      // s between two updates of adaptive sampling

/** Wire of the longest instrument, which determines the nodes. */
const rod::Wire& longestWire(const scene::Scene& scene)
{
  return std::max_element(scene.instruments.begin(), scene.instruments.end(),
                          [](const scene::DrivenInstrument& a, const scene::DrivenInstrument& b)
                          { return a.instrument.wire.length() < b.instrument.wire.length(); })
      ->instrument.wire;
}

/** Longest edge of the scene's wire [m]. */
double longestEdge(const scene::Scene& scene)
{
  if (scene.sampling.kind == scene::SamplingKind::kAdaptive)
    return scene.sampling.max_edge;
  return longestWire(scene).length() / (scene.sampling.nodes - 1);
}

std::uint64_t stepsIn(double seconds, const scene::Scene& scene)
{
  return static_cast<std::uint64_t>(std::max(1.0, std::round(seconds / scene.solver.time_step)));
}

}  // namespace

rod::Boundary boundaryOf(const scene::Scene& scene, const scene::EntryPose& entry)
{
  rod::Boundary boundary;
  boundary.introducer = scene.introducer;
  boundary.origin = entry.position;
  boundary.direction = entry.direction;
  boundary.director = entry.d1;
  boundary.guide_length = scene.solver.guide_length;
  boundary.guide_decay = std::max(boundary.guide_decay, kDecayPerEdge * longestEdge(scene));
  double radius = 0.0;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    for (const rod::Section& section : driven.instrument.wire.sections)
      radius = std::max(radius, section.radius);
  boundary.sheath_clearance = std::max(kLeastClearance, kClearanceShare * (entry.wall_distance - radius));
  boundary.proximal = scene.proximal_end;
  boundary.distal = scene.distal_end;
  boundary.distal_twist_held = scene.distal.twist_held;
  return boundary;
}

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
    ahead = [curvature = vessel::CentrelineCurvature(*centreline)](const Eigen::Vector3d& point)
    { return curvature.at(point); };
  return std::make_unique<rod::AdaptiveSampling>(longestWire(scene), boundaryOf(scene, entry), settings, ahead);
}

rod::Discretisation initialNodes(const scene::Scene& scene, const rod::AdaptiveSampling* sampling)
{
  const rod::Wire& wire = longestWire(scene);
  if (sampling != nullptr)
    return sampling->discretisation();
  if (scene.introducer && scene.instruments.size() == 1 && scene.solver.scheme == "kkt")
    return rod::discretise(wire, rod::resolvedPositions(wire, scene.sampling.nodes, kStraighteningError));
  return rod::discretiseUniformly(wire, scene.sampling.nodes);
}

std::unique_ptr<rod::Stepper> makeStepper(const scene::Scene& scene, const scene::EntryPose& entry,
                                          rod::Discretisation nodes)
{
  rod::Environment environment;
  environment.gravity = scene.loads.gravity;
  environment.fluid_density = scene.loads.fluid_density;
  environment.drag_coefficient = scene.loads.drag_coefficient;
  environment.damping = scene.loads.damping;
  rod::StepperSettings settings = scene.solver.stepper;
  settings.curved_wall = settings.curved_wall || (scene.vessel && scene.vessel->wall == contact::WallShape::kSmooth);
  const rod::Boundary boundary = boundaryOf(scene, entry);
  if (scene.instruments.size() > 1)
  {
    std::vector<rod::Layer> layers;
    for (const scene::DrivenInstrument& driven : scene.instruments)
      layers.push_back({driven.instrument.wire, driven.friction, driven.fit_load, driven.instrument.inner_radius});
    return std::make_unique<rod::KktStepper>(layers, nodes.position, boundary, environment, settings);
  }
  if (scene.solver.scheme == "paper")
    return std::make_unique<rod::PaperStepper>(std::move(nodes), boundary, environment, settings);
  if (scene.solver.scheme == "mixed")
    return std::make_unique<rod::MixedStepper>(scene.instruments.front().instrument.wire, std::move(nodes), boundary,
                                               environment, settings);
  return std::make_unique<rod::KktStepper>(std::move(nodes), boundary, environment, settings);
}

}  // namespace endovascular_sim::simulation
