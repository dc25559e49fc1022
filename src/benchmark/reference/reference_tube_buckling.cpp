#include "benchmark/reference/reference_tube_buckling.h"

#include <cmath>
#include <limits>
#include <vector>

#include "benchmark/reference/smooth_walls.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** Places a wire of equal edges on the bottom of a straight tube with a lateral amplitude of 0.05 clearances, in a
 * shape that differs from the solution. The first node is unchanged. */
void layOnTheBottom(std::vector<Eigen::Vector3d>& x, double edge, double clearance)
{
  const double side = 0.05 * clearance;
  for (std::size_t i = 1; i < x.size(); ++i)
  {
    const double s = M_PI * static_cast<double>(i) / static_cast<double>(x.size() - 1);
    const double y = side * (std::sin(3.0 * s) + 0.3 * std::sin(2.0 * s) + 0.2 * std::sin(5.0 * s));
    const double z = -std::sqrt(clearance * clearance - y * y);
    const double dy = y - x[i - 1].y();
    const double dz = z - x[i - 1].z();
    x[i] = Eigen::Vector3d(x[i - 1].x() + std::sqrt(edge * edge - dy * dy - dz * dz), y, z);
  }
}

/** Bend of the tube with the initial shape of the wire. */
struct Bend
{
  double radius = 0.1;       ///< radius of the axis of the tube [m]
  double clearance = 5e-4;   ///< radial clearance of the wire [m]
  double amplitude = 0.1;    ///< lateral amplitude as an angle about the axis of the tube [rad]
  double wave_number = 0.0;  ///< wave number along the wire [1/m]

  double outer() const { return radius + clearance; }
};

/** Places a wire on the outer side of a bend with a lateral amplitude. The centres of the end edges lie on the arc, and
 * the first edge is unchanged.
 *  @return angle of the bend between both clamps [rad] */
double layOnTheOuterSide(std::vector<Eigen::Vector3d>& x, double edge, const Bend& bend)
{
  const int last = static_cast<int>(x.size()) - 1;
  const double length = (last - 1) * edge;
  double turn = std::atan(0.5 * edge / bend.outer());
  for (int i = 2; i < last; ++i)
  {
    const double s = (i - 0.5) * edge;
    const double around = bend.amplitude * std::sin(bend.wave_number * s) * std::pow(std::sin(M_PI * s / length), 2.0);
    const double radius = bend.radius + bend.clearance * std::cos(around);
    const double z = bend.clearance * std::sin(around);
    const double before = std::hypot(x[i - 1].x(), x[i - 1].y() - bend.radius);
    const double in_plane = edge * edge - (z - x[i - 1].z()) * (z - x[i - 1].z());
    turn += std::acos((radius * radius + before * before - in_plane) / (2.0 * radius * before));
    x[i] = Eigen::Vector3d(radius * std::sin(turn), bend.radius - radius * std::cos(turn), z);
  }
  turn += std::atan(0.5 * edge / bend.outer());
  const Eigen::Vector3d end(bend.outer() * std::sin(turn), bend.radius - bend.outer() * std::cos(turn), 0.0);
  const Eigen::Vector3d half_edge = 0.5 * edge * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.0);
  x[last - 1] = end - half_edge;
  x[last] = end + half_edge;
  return turn;
}

}  // namespace

Measured buckleInATube(const std::string& scheme, int nodes)
{
  constexpr double kClearance = 1e-3;
  constexpr double kGravity = 9.81;
  const bool paper = scheme == "paper";
  ReferenceRod rod;
  rod.nodes = nodes;
  const double weight = kGravity * rod.lineDensity();
  rod.length = 10.0 * std::pow(rod.bending_stiffness * kClearance / weight, 0.25);
  rod::Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = boundary.distal = rod::EndHold::kPinned;
  boundary.origin = Eigen::Vector3d(0.0, 0.0, -kClearance);
  rod::Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, 0.0, -kGravity);
  environment.damping = paper ? 50.0 : 0.0;
  ReferenceWire wire(scheme, rod, boundary, environment, stiffContactSettings());
  BentTube tube(kClearance, 0.0, std::numeric_limits<double>::infinity(), 0.0);
  wire.wall = &tube;
  layOnTheBottom(wire.state.position, rod.length / (nodes - 1), kClearance);
  wire.input.distal.displacement.x() = wire.state.position.back().x() - rod.length;
  wire.state.distal = wire.input.distal;
  const bool rests = wire.settle(paper ? 1e-4 : 5e-3, !paper, 1e-11, 50000);
  const double scale = std::sqrt(rod.bending_stiffness * weight / kClearance);
  return {wire.state.hand_force / scale, wire.stepTime(), rests ? "" : "not at rest"};
}

Measured buckleInABentTube(const std::string& scheme, int nodes)
{
  const bool paper = scheme == "paper";
  Bend bend;
  bend.amplitude = paper ? 0.3 : 0.1;  // its compliant wall takes up part of the shortening
  bend.wave_number = std::sqrt(2.0 / (bend.clearance * bend.radius));
  const double length = 40.0 / bend.wave_number;
  const double edge = length / (nodes - 2);
  ReferenceRod rod;
  rod.nodes = nodes;
  rod.length = length + edge;
  rod::Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = boundary.distal = rod::EndHold::kClamped;
  boundary.origin = Eigen::Vector3d(-0.5 * edge, -bend.clearance, 0.0);
  rod::Environment environment;
  environment.damping = paper ? 2000.0 : 0.0;
  ReferenceWire wire(scheme, rod, boundary, environment, stiffContactSettings());
  BentTube tube(bend.clearance, 0.0, bend.radius, 0.9 * M_PI);
  wire.wall = &tube;
  std::vector<Eigen::Vector3d>& x = wire.state.position;
  const Eigen::Vector3d anchor = 0.5 * (x[nodes - 1] + x[nodes - 2]);
  wire.input.distal.tilt.z() = layOnTheOuterSide(x, edge, bend);
  wire.input.distal.displacement = 0.5 * (x[nodes - 1] + x[nodes - 2]) - anchor;
  wire.state.distal = wire.input.distal;
  const bool rests = wire.settle(paper ? 3e-6 : 1e-4, !paper, 1e-10, 20000);
  return {wire.state.hand_force * bend.clearance * bend.radius / (4.0 * rod.bending_stiffness), wire.stepTime(),
          rests ? "" : "not at rest"};
}

}  // namespace endovascular_sim::benchmark
