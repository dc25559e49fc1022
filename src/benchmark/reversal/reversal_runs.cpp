#include "benchmark/reversal/reversal_runs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "benchmark/reference/smooth_walls.h"
#include "common/time/processor_time.h"
#include "contact/detector.h"
#include "rod/kkt/kkt_stepper.h"
#include "vessel/anatomy/tube.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Vector3d;

constexpr double kRestStep = 1e-3;  // time step of the preparation [s]

rod::Wire uniformWire(double length, double radius, double density, double bending, double torsion)
{
  rod::Section section;
  section.length = length;
  section.radius = radius;
  section.density = density;
  section.bending_stiffness = bending;
  section.torsional_stiffness = torsion;
  rod::Wire wire;
  wire.sections.push_back(section);
  return wire;
}

class BendCase : public ReversalCase
{
public:
  explicit BendCase(const rod::StepperSettings& settings) : ReversalCase(settings), wall_(tube(), law()) {}

protected:
  std::unique_ptr<rod::Stepper> makeStepper(const rod::StepperSettings& settings) const override
  {
    const rod::Wire wire = uniformWire(0.3, 4.445e-4, 6450.0, 291e-6, 291e-6 / 1.3);
    rod::Boundary boundary;
    boundary.direction = Vector3d::UnitZ();
    boundary.director = Vector3d::UnitX();
    return std::make_unique<rod::KktStepper>(rod::discretiseUniformly(wire, 150), boundary, rod::Environment(),
                                             settings);
  }

  contact::ContactSource& wall() override { return wall_; }

  void prepare(rod::Stepper& stepper, rod::State& state, rod::StepInput& input) override
  {
    input.inserted_length = 0.01;
    state = stepper.initialState(input.inserted_length, 0.0);
    for (int k = 0; k < 4000; ++k)
    {
      input.inserted_length = std::min(0.12, input.inserted_length + 0.03 * kRestStep);
      advance(stepper, state, input, kRestStep);
    }
  }

private:
  static geometry::TriangleMesh tube()
  {
    vessel::TubeShape shape;
    shape.radius = 3e-3;
    shape.facet_length = 1e-3;
    shape.facets_around = 48;
    shape.pieces = {{0.05, 0.0, 0.0}, {0.5 * M_PI * 0.03, 1.0 / 0.03, 0.0}, {0.05, 0.0, 0.0}};
    return vessel::tubeMesh(shape);
  }

  static contact::WallLaw law()
  {
    contact::WallLaw law;
    law.friction = 0.1;
    return law;
  }

  contact::Detector wall_;
};

class TroughCase : public ReversalCase
{
public:
  explicit TroughCase(const rod::StepperSettings& settings) : ReversalCase(settings), wall_(kClearance, 0.2) {}

protected:
  std::unique_ptr<rod::Stepper> makeStepper(const rod::StepperSettings& settings) const override
  {
    const rod::Wire wire = uniformWire(0.2, 1.8e-4, 7900.0, 1e-5, 1e-5);
    rod::Boundary boundary;
    boundary.origin = Vector3d(0.0, 0.0, -kClearance);
    rod::Environment environment;
    environment.gravity = Vector3d(0.0, 0.0, -1000.0);
    environment.damping = 100.0;
    return std::make_unique<rod::KktStepper>(rod::discretiseUniformly(wire, 101), boundary, environment, settings);
  }

  contact::ContactSource& wall() override { return wall_; }

  void prepare(rod::Stepper& stepper, rod::State& state, rod::StepInput& input) override
  {
    input.inserted_length = 0.15;
    state = stepper.initialState(input.inserted_length, 0.0);
    for (int k = 0; k < 200; ++k)
      advance(stepper, state, input, kRestStep);
  }

private:
  static constexpr double kClearance = 2e-4;  // m
  Trough wall_;
};

}  // namespace

double worstDeviation(const ReversalCurve& curve, const ReversalCurve& reference)
{
  double worst = 0.0;
  for (std::size_t k = reference.torque.size() / 2; k < reference.torque.size(); ++k)
    worst = std::max(worst, std::abs(curve.torque[k] - reference.torque[k]));
  return worst / std::abs(reference.slidingTorque());
}

int ReversalCase::advance(rod::Stepper& stepper, rod::State& state, rod::StepInput& input, double time_step)
{
  std::uint32_t pass = 0;
  PhaseTimer timer;
  ++input.step;
  const rod::StepReport report = stepper.step(state, input, time_step, pass, &wall(), timer);
  if (!report.solved)
    throw std::runtime_error("reversal: a step was rejected");
  return report.factorisations;
}

ReversalCurve ReversalCase::run(const ReversalMotion& motion)
{
  const std::unique_ptr<rod::Stepper> stepper = makeStepper(settings_);
  if (!prepared_)
    prepare(*stepper, rest_, rest_input_);
  prepared_ = true;
  rod::State state = rest_;
  rod::StepInput input = rest_input_;
  stepper->invalidateContacts();
  ReversalCurve curve;
  curve.angle = {0.0};
  curve.torque = {torque(state)};
  const auto steps = static_cast<int>(std::lround(motion.amplitude / (motion.rate * motion.time_step)));
  const int half = steps / 2;  // last step before the measured part of the way up
  int sample = 1;
  double begin = 0.0;
  for (int k = 1; k <= 2 * steps; ++k)
  {
    const double before = input.rotation;
    turnHandle(input, motion.amplitude * (1.0 - std::abs(static_cast<double>(k) / steps - 1.0)));
    const double torque_before = torque(state);
    if (k == half + 1)
      begin = processorSeconds();
    const int factorisations = advance(*stepper, state, input, motion.time_step);
    if (k > half && k <= steps)
      curve.solves += factorisations;
    if (k == steps)
    {
      curve.step_us = 1e6 * (processorSeconds() - begin) / static_cast<double>(steps - half);
      curve.solves /= static_cast<double>(steps - half);
    }
    for (; sample <= 2 * motion.samples && static_cast<double>(sample) / motion.samples <= 1.0 * k / steps; ++sample)
    {
      const double wanted = motion.amplitude * (1.0 - std::abs(static_cast<double>(sample) / motion.samples - 1.0));
      const double share = (wanted - before) / (input.rotation - before);
      curve.angle.push_back(wanted);
      curve.torque.push_back(torque_before + share * (torque(state) - torque_before));
    }
  }
  return curve;
}

std::unique_ptr<ReversalCase> reversalInBend(const rod::StepperSettings& settings)
{
  return std::make_unique<BendCase>(settings);
}

std::unique_ptr<ReversalCase> reversalInTrough(const rod::StepperSettings& settings)
{
  return std::make_unique<TroughCase>(settings);
}

}  // namespace endovascular_sim::benchmark
