#include "benchmark/reference/reference_wire.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "rod/kkt/kkt_stepper.h"
#include "rod/mixed/mixed_stepper.h"
#include "rod/paper/paper_stepper.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Clock = std::chrono::steady_clock;

rod::Wire wireOf(const ReferenceRod& rod)
{
  rod::Section section;
  section.length = rod.length;
  section.bending_stiffness = rod.bending_stiffness;
  section.torsional_stiffness = rod.torsional_stiffness;
  section.axial_stiffness = 4.0 * rod.bending_stiffness / (rod.radius * rod.radius);
  section.radius = rod.radius;
  section.density = rod.density;
  section.rest_curvature = Eigen::Vector2d(rod.rest_curvature, 0.0);
  rod::Wire wire;
  wire.sections = {section};
  return wire;
}

std::unique_ptr<rod::Stepper> makeStepper(const std::string& scheme, const ReferenceRod& rod,
                                          const rod::Boundary& boundary, const rod::Environment& environment,
                                          const rod::StepperSettings& settings)
{
  const rod::Wire wire = wireOf(rod);
  rod::Discretisation nodes = rod::discretiseUniformly(wire, rod.nodes);
  if (scheme == "paper")
    return std::make_unique<rod::PaperStepper>(std::move(nodes), boundary, environment, settings);
  if (scheme == "mixed")
    return std::make_unique<rod::MixedStepper>(wire, std::move(nodes), boundary, environment, settings);
  return std::make_unique<rod::KktStepper>(std::move(nodes), boundary, environment, settings);
}

}  // namespace

rod::StepperSettings stiffContactSettings()
{
  rod::StepperSettings settings;
  settings.strain_tolerance = 1e-6;
  settings.contact_stiffness = 1e6;
  settings.corrected_strain_ratio = 0.0;
  settings.max_iterations = 30;
  return settings;
}

double ReferenceRod::lineDensity() const
{
  return density * M_PI * radius * radius;
}

ReferenceWire::ReferenceWire(const std::string& scheme, const ReferenceRod& rod, const rod::Boundary& boundary,
                             const rod::Environment& environment, rod::StepperSettings settings, double inserted_length)
  : stepper_(makeStepper(scheme, rod, boundary, environment, settings))
{
  state = stepper_->initialState(inserted_length, 0.0);
  input.inserted_length = inserted_length;
}

bool ReferenceWire::step(double dt)
{
  std::uint32_t pass = 0;
  const Clock::time_point start = Clock::now();
  const rod::StepReport report = stepper_->step(state, input, dt, pass, wall, timer_);
  times_.push_back(1e6 * std::chrono::duration<double>(Clock::now() - start).count());
  ++input.step;
  return report.solved;
}

bool ReferenceWire::settle(double dt, bool from_rest, double tolerance, int max_steps)
{
  std::vector<Eigen::Vector3d> before;
  for (int k = 0; k < max_steps; ++k)
  {
    before = state.position;
    if (from_rest)
      std::fill(state.velocity.begin(), state.velocity.end(), Eigen::Vector3d::Zero());
    if (!step(dt))
      return false;
    double motion = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
      motion = std::max(motion, (state.position[i] - before[i]).norm());
    if (motion < tolerance && k > 10)
      return true;
  }
  return false;
}

double ReferenceWire::stepTime() const
{
  if (times_.empty())
    return NAN;
  std::vector<double> sorted = times_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

rod::Boundary clampAtOrigin(const std::string& scheme, ReferenceRod& rod)
{
  rod::Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = rod::EndHold::kClamped;
  if (scheme == "mixed")
    return boundary;
  const double half_edge = 0.5 * rod.length / (rod.nodes - 1.5);
  boundary.origin = Eigen::Vector3d(-half_edge, 0.0, 0.0);
  rod.length += half_edge;
  return boundary;
}

}  // namespace endovascular_sim::benchmark
