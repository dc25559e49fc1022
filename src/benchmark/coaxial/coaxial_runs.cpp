#include "benchmark/coaxial/coaxial_runs.h"

#include <cmath>
#include <stdexcept>

#include "benchmark/reference/reference_wire.h"
#include "benchmark/reference/smooth_walls.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Vector3d;

constexpr double kBendRadius = 0.03;  // m
// m, straight part from the introducer to the bend. The introducer's mouth clamps the wire of the reference, but not a
// wire in a catheter: it must be far from the bend.
constexpr double kBefore = 0.1;
constexpr double kBeyond = 0.02;      // m, straight part of the catheter after the bend
constexpr double kProtrusion = 0.02;  // m, of the wire beyond the catheter
constexpr double kSpare = 0.03;       // m of the wire outside the introducer
constexpr double kWireRadius = 4.445e-4;
constexpr double kCatheterClearance = 5e-6;  // m between catheter and vessel: it follows the bend
constexpr double kTimeStep = 1e-3;           // s
constexpr double kReferenceStep = 2e-4;      // s: friction of walls uses normal forces of the last solution
constexpr double kSpeed = 3e-3;              // m/s
constexpr double kRest = 0.1;                // s before the motion
constexpr double kStart = 4e-3;              // m of sliding before the force is measured: takes up the slack c·θ

/** Path of the bend by arc length from the introducer. */
Vector3d pathAt(double s, double angle)
{
  const double turn = std::clamp((s - kBefore) / kBendRadius, 0.0, angle);
  const double straight = s - std::max(0.0, turn) * kBendRadius;
  const Vector3d arc(kBendRadius * std::sin(turn), kBendRadius * (1.0 - std::cos(turn)), 0.0);
  if (s < kBefore)
    return {s, 0.0, 0.0};
  return Vector3d(kBefore, 0.0, 0.0) + arc + (straight - kBefore) * Vector3d(std::cos(turn), std::sin(turn), 0.0);
}

rod::Wire uniformWire(double length, double radius, double bending)
{
  rod::Section section;
  section.length = length;
  section.radius = radius;
  section.density = 6450.0;
  section.bending_stiffness = bending;
  section.torsional_stiffness = bending / 1.3;
  rod::Wire wire;
  wire.sections.push_back(section);
  return wire;
}

double insertedLength(const CoaxialCase& at)
{
  return kBefore + kBendRadius * at.angle + kBeyond + kProtrusion;
}

std::vector<double> nodesOf(const CoaxialCase& at)
{
  const double length = insertedLength(at) + kSpare;
  const int edges = static_cast<int>(std::lround(length / at.edge));
  std::vector<double> position;
  for (int i = 0; i <= edges; ++i)
    position.push_back(length * i / edges);
  return position;
}

rod::Environment surroundings()
{
  rod::Environment environment;
  environment.damping = 50.0;
  return environment;
}

rod::Boundary introducer()
{
  rod::Boundary boundary;
  boundary.guide_length = 8e-3;
  return boundary;
}

void bendTo(const CoaxialCase& at, const std::vector<double>& position, rod::State& state)
{
  const double outside = position.back() - insertedLength(at);
  for (std::size_t i = 0; i < position.size(); ++i)
    state.position[i] = pathAt(position[i] - outside, at.angle);
}

Vector3d tipForce(const CoaxialCase& at)
{
  return at.tip_tension * Vector3d(std::cos(at.angle), std::sin(at.angle), 0.0);
}

/** Mean over whole edges, so that the passage of nodes has no part in it. */
double measuredTravel(const CoaxialCase& at)
{
  return at.edge * std::ceil(1e-3 / at.edge);
}

}  // namespace

class CoaxialPair::Wall : public BentTube
{
public:
  explicit Wall(const CoaxialCase& at)
    : BentTube(kCatheterClearance, kBefore, kBendRadius, at.angle), ends_(at.tip_across != 0.0)
  {
  }

private:
  bool measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override
  {
    return (!ends_ || axis.x() < kBefore + kBeyond) && BentTube::measure(axis, face, feature);
  }

  bool ends_;
};

CoaxialPair::~CoaxialPair() = default;

CoaxialPair::CoaxialPair(const CoaxialCase& at) : wall_(std::make_unique<Wall>(at))
{
  const double inserted = insertedLength(at);
  rod::Layer wire;
  wire.wire = uniformWire(inserted + kSpare, kWireRadius, at.bending_stiffness);
  wire.friction = at.friction;
  rod::Layer catheter;
  catheter.wire = uniformWire(inserted + kSpare, 1e-3, 590e-6);
  catheter.lumen = kWireRadius + at.clearance;
  const std::vector<double> position = nodesOf(at);
  stepper_ = std::make_unique<rod::KktStepper>(std::vector<rod::Layer>{wire, catheter}, position, introducer(),
                                               surroundings(), stiffContactSettings());
  input_.layers = {{inserted, 0.0}, {inserted - kProtrusion, 0.0}};
  state_ = stepper_->initialState(input_.layers);
  bendTo(at, position, state_);
  input_.forces.push_back({static_cast<int>(position.size()) - 1, tipForce(at) + at.tip_across * Vector3d::UnitZ()});
  for (int k = 0; k < std::lround(kRest / kTimeStep); ++k)
    step();
  work_ = 0.0;
}

void CoaxialPair::step()
{
  std::uint32_t pass = 0;
  ++input_.step;
  std::vector<double> before;
  for (const rod::LayerState& layer : state_.layers)
    before.push_back(layer.inserted_length);
  if (!stepper_->step(state_, input_, kTimeStep, pass, wall_.get(), timer_).solved)
    throw std::runtime_error("coaxial: a step was rejected");
  for (std::size_t k = 0; k < before.size(); ++k)
    work_ += state_.layers[k].hand_force * (state_.layers[k].inserted_length - before[k]);
}

double CoaxialPair::move(double travel)
{
  const int steps = std::max(1, static_cast<int>(std::lround(std::abs(travel) / (kSpeed * kTimeStep))));
  const double start = input_.layers[0].inserted_length;
  double sum = 0.0;
  for (int k = 1; k <= steps; ++k)
  {
    input_.layers[0].inserted_length = start + travel * k / steps;
    step();
    sum += state_.layers[0].hand_force;
  }
  return sum / steps;
}

double forceInCatheter(const CoaxialCase& at)
{
  CoaxialPair pair(at);
  const double direction = at.pull ? -1.0 : 1.0;
  pair.move(direction * kStart);
  return direction * pair.move(direction * measuredTravel(at));
}

double forceInTube(const CoaxialCase& at)
{
  ReferenceRod rod;
  rod.length = insertedLength(at) + kSpare;
  rod.bending_stiffness = at.bending_stiffness;
  rod.torsional_stiffness = at.bending_stiffness / 1.3;
  rod.radius = kWireRadius;
  rod.density = 6450.0;
  const std::vector<double> position = nodesOf(at);
  rod.nodes = static_cast<int>(position.size());
  ReferenceWire wire("kkt", rod, introducer(), surroundings(), stiffContactSettings(), insertedLength(at));
  BentTube tube(at.clearance, kBefore, kBendRadius, at.angle, at.friction);
  wire.wall = &tube;
  bendTo(at, position, wire.state);
  wire.input.forces.push_back({rod.nodes - 1, tipForce(at)});
  const double direction = at.pull ? -1.0 : 1.0;
  const auto move = [&](double travel, double speed)
  {
    const int steps = static_cast<int>(std::lround(travel / (kSpeed * kReferenceStep)));
    double sum = 0.0;
    for (int k = 0; k < steps; ++k)
    {
      wire.input.inserted_length += direction * speed * kReferenceStep;
      if (!wire.step(kReferenceStep))
        throw std::runtime_error("coaxial: a step of the reference was rejected");
      sum += wire.state.hand_force;
    }
    return sum / steps;
  };
  move(kSpeed * kRest, 0.0);
  move(kStart, kSpeed);
  return direction * move(measuredTravel(at), kSpeed);
}

}  // namespace endovascular_sim::benchmark
