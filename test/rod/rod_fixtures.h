#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "rod/boundary/introducer_guide.h"
#include "rod/kkt/kkt_stepper.h"

namespace endovascular_sim::rod
{

/** Straight wire of one section. */
inline Wire uniformWire(double length, double bending_stiffness, double radius, double density)
{
  Section section;
  section.length = length;
  section.bending_stiffness = bending_stiffness;
  section.torsional_stiffness = bending_stiffness / 1.3;
  section.axial_stiffness = 4.0 * bending_stiffness / (radius * radius);
  section.radius = radius;
  section.density = density;
  Wire wire;
  wire.sections = {section};
  return wire;
}

/** Boundary of a bench wire along x that is clamped exactly at the origin: the clamp of the discrete rod acts at the
 *  middle of the first edge.
 *  @param length free length [m] */
inline Boundary clampAtOrigin(double length, int nodes)
{
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  boundary.origin = Eigen::Vector3d(-0.5 * length / (nodes - 1.5), 0.0, 0.0);
  return boundary;
}

/** Total length of a wire with the free length @p length beyond a clamp at the middle of an edge. */
inline double clampedLength(double length, int nodes)
{
  return length * (nodes - 1) / (nodes - 1.5);
}

/** Boundary of a bench wire along x that is held at both ends, at the origin and at (length, 0, 0); clamps act at the
 *  middles of the end edges of the wire of heldLength(). */
inline Boundary heldAtBothEnds(double length, int nodes, EndHold hold)
{
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = boundary.distal = hold;
  if (hold == EndHold::kClamped)
    boundary.origin = Eigen::Vector3d(-0.5 * length / (nodes - 2), 0.0, 0.0);
  return boundary;
}

/** Total length of a wire with @p length between its holds. */
inline double heldLength(double length, int nodes, EndHold hold)
{
  return hold == EndHold::kClamped ? length * (nodes - 1) / (nodes - 2) : length;
}

/** Energy of the introducer's guide [J]. */
inline double guideEnergy(const Discretisation& rod, const Boundary& boundary, const State& state)
{
  double sum = 0.0;
  IntroducerGuide(boundary).forEachEdge(rod, state,
                                        [&sum](int /*edge*/, const GuidedEdge& edge) { sum += edge.energy; });
  return sum;
}

/** Drag of a uniform stream on all nodes, the same per length.
 *  @param per_length [N·s/m²]
 *  @param stream velocity of the fluid [m/s] */
inline std::vector<NodalDrag> uniformStream(const Discretisation& rod, const Eigen::Matrix3d& per_length,
                                            const Eigen::Vector3d& stream)
{
  std::vector<NodalDrag> drags;
  for (int i = 0; i < rod.nodes(); ++i)
    drags.push_back({i, rod.cell_length[i] * per_length, stream});
  return drags;
}

/** Advances a wire without walls by one step. */
inline StepReport advanceFreely(Stepper& stepper, State& state, const StepInput& input, double dt)
{
  PhaseTimer timer;
  std::uint32_t pass = 0;
  return stepper.step(state, input, dt, pass, nullptr, timer);
}

/** Steps until the wire is at rest.
 *  @return the number of steps, or −1 when it does not come to rest */
inline int settle(Stepper& stepper, State& state, StepInput input, double dt, double slowest, int max_steps)
{
  PhaseTimer timer;
  for (int k = 0; k < max_steps; ++k)
  {
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    stepper.step(state, input, dt, pass, nullptr, timer);
    double fastest = 0.0;
    for (const Eigen::Vector3d& velocity : state.velocity)
      fastest = std::max(fastest, velocity.norm());
    if (fastest < slowest && k > 10)
      return k;
  }
  return -1;
}

/** Computes the static equilibrium of the discrete wire. Every step starts from rest, so that it is a damped Newton
 *  iteration on the energy. Shorter steps follow, because the constraints yield by 1e-10·tension·Δt².
 *  @param dt of the long steps, about the inverse of the lowest frequency [s]
 *  @return false when it still moves by more than 1e-13 m per step at the end */
inline bool relaxToEquilibrium(KktStepper& stepper, State& state, StepInput input, double dt)
{
  PhaseTimer timer;
  std::vector<Eigen::Vector3d> before;
  bool at_rest = false;
  for (const double step : {dt, 0.1 * dt})
  {
    at_rest = false;
    for (int k = 0; k < 5000 && !at_rest; ++k)
    {
      std::uint32_t pass = 0;
      before = state.position;
      for (Eigen::Vector3d& velocity : state.velocity)
        velocity.setZero();
      if (!stepper.step(state, input, step, pass, nullptr, timer).solved)
        return false;
      ++input.step;
      double motion = 0.0;
      for (std::size_t i = 0; i < before.size(); ++i)
        motion = std::max(motion, (state.position[i] - before[i]).norm());
      at_rest = motion < 1e-13;
    }
  }
  return at_rest;
}

/** Wire with a soft tip of 16 mm whose rest curvature has both components. @param curvature [1/m] */
inline Wire curvedTipWire(double curvature)
{
  Wire wire = uniformWire(0.08, 2.463e-3, 4.45e-4, 6450.0);
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.016;
  wire.sections[1].bending_stiffness = 2e-4;
  wire.sections[1].torsional_stiffness = 2e-4 / 1.49;
  wire.sections[1].rest_curvature = Eigen::Vector2d(0.3 * curvature, -curvature);
  return wire;
}

}  // namespace endovascular_sim::rod
