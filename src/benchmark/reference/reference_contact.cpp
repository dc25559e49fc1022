#include "benchmark/reference/reference_contact.h"

#include <algorithm>
#include <cmath>

#include "benchmark/reference/reference_wire.h"
#include "benchmark/reference/smooth_walls.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** Scheme `paper` requires short steps: its contact yields by F Δt²/m. */
bool isPaper(const std::string& scheme)
{
  return scheme == "paper";
}

}  // namespace

Measured ceilingForce(const std::string& scheme, double turn, double height, int nodes)
{
  const double length = 0.02;
  ReferenceRod rod;
  rod.length = length;
  rod.nodes = nodes;
  rod.rest_curvature = turn / length;
  const double frequency = 3.516 * std::sqrt(rod.bending_stiffness / rod.lineDensity()) / (length * length);
  const rod::Boundary boundary = clampAtOrigin(scheme, rod);
  rod::Environment environment;
  environment.damping = isPaper(scheme) ? 2.0 * frequency : 0.0;
  rod::StepperSettings stiff = stiffContactSettings();
  stiff.contact_stiffness = 1e7;  // compliance acts as additional height
  ReferenceWire wire(scheme, rod, boundary, environment, stiff);
  FlatChannel channel(height * length);
  wire.wall = &channel;
  const bool rests = isPaper(scheme) ? wire.settle(4e-3 / frequency, false, 1e-10, 20000)
                                     : wire.settle(1.0 / frequency, true, 1e-13, 5000);
  return {wire.state.wall_force.back().norm() * length * length / rod.bending_stiffness, wire.stepTime(),
          rests ? "" : "not at rest"};
}

Measured capstanRatio(const std::string& scheme, int nodes, double speed)
{
  constexpr double kPegRadius = 0.02;
  constexpr double kSpan = 0.04;  // length on each side: six decay lengths of bending
  constexpr double kFriction = 0.3;
  ReferenceRod rod;
  const double slack = rod.bending_stiffness / (0.1 * kPegRadius * kPegRadius);
  // Far from the peg, a span approaches a line at distance R + EI/(2 T R) from its centre.
  const double line = kPegRadius + rod.bending_stiffness / (2.0 * kCapstanRatio * slack * kPegRadius);
  const double inserted = 2.0 * kSpan + 0.5 * M_PI * line;
  rod.nodes = nodes;
  rod.length = inserted + 0.005;
  const double edge = rod.length / (nodes - 1);
  rod::Boundary boundary;
  boundary.guide_length = 1e-3;
  rod::Environment environment;
  environment.damping = 100.0;
  ReferenceWire wire(scheme, rod, boundary, environment, stiffContactSettings(), inserted);
  Peg peg(Eigen::Vector3d(kSpan, -line, 0.0), kPegRadius, kFriction);
  wire.wall = &peg;
  for (Eigen::Vector3d& x : wire.state.position)
  {
    const double bent = x.x() - kSpan;
    const double turn = std::min(bent / line, 0.5 * M_PI);
    if (bent > 0.0)
      x = Eigen::Vector3d(kSpan + line * std::sin(turn), -line * (1.0 - std::cos(turn)) - (bent - line * turn), 0.0);
  }
  wire.input.forces.push_back({nodes - 1, Eigen::Vector3d(0.0, -slack, 0.0)});
  const double dt = isPaper(scheme) ? 1e-6 : 5e-4;
  Measured result;
  const auto run = [&](double seconds, double velocity)
  {
    double sum = 0.0;
    const int steps = static_cast<int>(std::lround(seconds / dt));
    for (int k = 0; k < steps; ++k)
    {
      wire.input.inserted_length -= velocity * dt;
      if (!wire.step(dt))
        result.note = "steps rejected";
      sum -= wire.state.hand_force;
    }
    return sum / steps;
  };
  run(0.04, 0.0);
  run(2.0 * edge / speed, speed);
  result.value = run(2.0 * edge / speed, speed) / slack;
  result.step_us = wire.stepTime();
  return result;
}

Insertion insertIntoABend(const std::string& scheme, int nodes)
{
  constexpr double kBendRadius = 0.03;
  constexpr double kStraight = 0.03;
  constexpr double kAngle = 0.5 * M_PI;
  constexpr double kSpeed = 0.05;
  constexpr double kWindow = 0.01;  // averaging window of travel [m]
  ReferenceRod rod;
  rod.length = 0.16;
  rod.nodes = nodes;
  rod.bending_stiffness = 3e-4;
  const double exact = 0.5 * rod.bending_stiffness / (kBendRadius * kBendRadius);
  ReferenceWire wire(scheme, rod, rod::Boundary(), rod::Environment(), stiffContactSettings(), kStraight);
  BentTube tube(0.01 * kBendRadius, kStraight, kBendRadius, kAngle);
  wire.wall = &tube;
  const double dt = isPaper(scheme) ? 2e-5 : 1e-3;
  Insertion result;
  const auto pushTo = [&](double inserted)
  {
    double sum = 0.0;
    const int steps = static_cast<int>(std::lround((inserted - wire.input.inserted_length) / (kSpeed * dt)));
    for (int k = 0; k < steps; ++k)
    {
      wire.input.inserted_length += kSpeed * dt;
      if (!wire.step(dt))
        result.note = "steps rejected";
      sum += wire.state.hand_force;
    }
    return sum / (steps * exact);
  };
  const double end = kStraight + kAngle * kBendRadius;
  pushTo(kStraight + 0.4 * kAngle * kBendRadius);
  result.filling = pushTo(wire.input.inserted_length + kWindow);
  pushTo(end + 0.01);
  result.beyond = pushTo(wire.input.inserted_length + kWindow);
  result.step_us = wire.stepTime();
  return result;
}

}  // namespace endovascular_sim::benchmark
