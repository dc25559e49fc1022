#include "benchmark/reference/static_cases.h"

#include <cmath>

namespace endovascular_sim::benchmark
{
namespace
{

/** Wire for which a load number of 1 is a force of 10 mN. */
BenchWire unitWire()
{
  BenchWire wire;
  wire.length = 0.1;
  wire.bending_stiffness = 1e-4;
  return wire;
}

double unitForce(const BenchWire& wire)
{
  return wire.bending_stiffness / (wire.length * wire.length);
}

StaticCase elastica(double load, double x, double y)
{
  StaticCase problem{"cantilever, tip force PL²/EI = " + std::to_string(static_cast<int>(load)),
                     "elliptic integrals",
                     unitWire(),
                     {x, y, 0.0}};
  problem.wire.tip_force.y() = load * unitForce(problem.wire);
  return problem;
}

StaticCase heavyElastica(double load, double x, double y)
{
  StaticCase problem{"heavy cantilever, wL³/EI = " + std::to_string(static_cast<int>(load)),
                     "boundary value problem",
                     unitWire(),
                     {x, -y, 0.0}};
  BenchWire& wire = problem.wire;
  const double weight = load * unitForce(wire) / wire.length;
  wire.gravity = weight / (wire.density * M_PI * wire.radius * wire.radius);
  return problem;
}

/** Arc of the given angle; load and tip are in units of its length. */
StaticCase arc(const std::string& name, double angle, const Eigen::Vector3d& load, const Eigen::Vector3d& tip)
{
  StaticCase problem{name, "boundary value problem", unitWire(), tip};
  problem.wire.rest_curvature = angle / problem.wire.length;
  problem.wire.tip_force = unitForce(problem.wire) * load;
  return problem;
}

/** Curved wire bent in space; the half next to the clamp is four times as stiff. */
StaticCase steppedArc()
{
  StaticCase problem = arc("curved wire, EI 4 : 1 at the middle, bent in space", 1.0, {-0.4, 0.7, 2.0},
                           {0.7691562357214236, 0.49857958885297754, 0.19955662871176527});
  problem.wire.near_stiffness = 4.0;
  return problem;
}

}  // namespace

std::vector<StaticCase> staticCases()
{
  // Elastica: elliptic integrals. All others: the boundary value problem of the inextensible Kirchhoff rod.
  const double angle = 0.25 * M_PI;
  return {elastica(1.0, 0.9435667637166234, 0.3017207737998133),
          elastica(10.0, 0.44500440224624865, 0.8106090248802966),
          heavyElastica(10.0, 0.6563537612385988, 0.7001997155143129),
          arc("quarter circle, in-plane tip force PL²/EI = 1", 0.5 * M_PI, {0.0, -1.0, 0.0},
              {0.804105101290247, 0.4818706970436423, 0.0}),
          steppedArc(),
          arc("45° arc, out-of-plane tip force FR²/EI = 3.6", angle, {0.0, 0.0, 3.6 * angle * angle},
              Eigen::Vector3d(0.5877968539120596, 0.2224503474206913, 0.4018828383798087) / angle)};
}

StaticCase heavyCantilever()
{
  StaticCase problem{"heavy cantilever of the published comparison", "boundary value problem", {}, {}};
  BenchWire& wire = problem.wire;
  wire.length = 0.38;
  wire.radius = 1.8e-4;
  wire.density = 7900.0;
  wire.gravity = 9.81;
  // wL³/EI is exactly 8.75, as in the reference; E = 60 GPa would give 8.75005.
  const double weight = wire.density * M_PI * wire.radius * wire.radius * wire.gravity;
  wire.bending_stiffness = weight * std::pow(wire.length, 3) / 8.75;
  problem.tip = {0.6975592593323616, -0.6655170278745548, 0.0};
  return problem;
}

double tipError(const StaticCase& problem, const RestResult& result)
{
  return (result.tip / problem.wire.length - problem.tip).norm();
}

BenchWire atRest(const StaticCase& problem, const std::string& scheme, int nodes)
{
  BenchWire wire = problem.wire;
  wire.scheme = scheme;
  wire.nodes = nodes;
  // A long implicit step approximates a static Newton step. `paper` is unstable at such steps and is damped to rest.
  const bool linear_implicit = scheme == "paper";
  wire.time_step = linear_implicit ? 1e-3 : 0.1;
  wire.damping = linear_implicit ? 30.0 : 0.0;
  return wire;
}

int restSteps(const std::string& scheme)
{
  return scheme == "paper" ? 40000 : 2000;
}

}  // namespace endovascular_sim::benchmark
