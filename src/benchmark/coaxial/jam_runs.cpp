#include "benchmark/coaxial/jam_runs.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "benchmark/reference/bore_equilibrium.h"
#include "benchmark/reference/reference_wire.h"
#include "benchmark/reference/smooth_walls.h"
#include "contact/detector.h"
#include "rod/energy/energy_audit.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/simulation.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Vector3d;

constexpr double kBendRadius = 0.03;      // m
constexpr double kBefore = 0.06;          // m, straight part before the first bend
constexpr double kBeyond = 0.03;          // m, straight part after the last one
constexpr double kProtrusion = 2e-3;      // m, of the wire beyond the catheter at the closed end
constexpr double kNarrow = 1e-4;          // m, clearance below which the catheter is thin
constexpr double kGap = 1e-4;             // m, between catheter and vessel
constexpr double kTip = 3e-3;             // m of the wire that do not buckle beyond the catheter
constexpr double kStiffTip = 10.0;        // bending stiffness over that of the wire
constexpr double kWireRadius = 2e-4;      // m
constexpr double kStiffness = 4e-5;       // N·m² of the wire
constexpr double kOutside = 0.04;         // m of the wire behind the introducer at the end
constexpr double kFast = 0.1;             // m/s, on the way
constexpr double kSlow = 8e-3;            // m/s, at the closed end
constexpr double kPushed = 6e-3;          // m beyond the closed end that the hand pushes
constexpr double kNoSlip = 1e-9;          // m, rounding
constexpr double kMeasuredTravel = 1e-3;  // m of the tip over which the force is averaged: one edge
constexpr double kMostTravel = 0.03;      // m of the hand, which also takes up the shortening by the helix

double bendsOf(JamPath path)
{
  return path == JamPath::kRightAngle ? 0.5 * M_PI : M_PI;
}

double lengthOf(JamPath path)
{
  return kBefore + kBendRadius * bendsOf(path) + kBeyond;
}

std::string piecesOf(JamPath path)
{
  std::ostringstream out;
  out.precision(12);
  const auto bend = [&](double angle, double plane)
  {
    out << "{length: " << kBendRadius * angle << ", curvature: " << 1.0 / kBendRadius << ", plane_angle: " << plane
        << "}, ";
  };
  out << "{length: " << kBefore << "}, ";
  if (path == JamPath::kS)
  {
    bend(0.5 * M_PI, 0.0);
    bend(0.5 * M_PI, M_PI);
  }
  else
    bend(bendsOf(path), 0.0);
  out << "{length: " << kBeyond << "}";
  return out.str();
}

std::string sectionOf(double length, double radius, double stiffness)
{
  std::ostringstream out;
  out.precision(12);
  out << "{length: " << length << ", radius: " << radius
      << ", material: steel, density: 5000, bending_stiffness: " << stiffness << ", poisson_ratio: 0.3}";
  return out.str();
}

/** @param tip length of a stiff tip [m] */
std::string instrumentOf(const std::string& name, double length, double tip, double radius, double stiffness,
                         const std::string& more)
{
  std::ostringstream out;
  out.precision(12);
  out << "  - instrument:\n      name: " << name << "\n      sections: [" << sectionOf(length - tip, radius, stiffness);
  if (tip > 0.0)
    out << ", " << sectionOf(tip, radius, kStiffTip * stiffness);
  out << "]\n" << more;
  return out.str();
}

std::string driveOf(double begin, double end, double pushed, double grip)
{
  std::ostringstream out;
  out.precision(12);
  const double arrival = 0.1 + (end - begin) / kFast;
  out << "    drive: {source: script, initial_insertion: " << begin << ", force_limit: " << grip
      << ", insertion: {points: [[0, 0], [0.1, 0], [" << arrival << ", " << end - begin << "], ["
      << arrival + kPushed / kSlow << ", " << end - begin + pushed << "], [1000, " << end - begin + pushed << "]]}}\n";
  return out.str();
}

/** Wire and catheter begin in the straight part and arrive together. */
std::string sceneOf(const JamCase& at)
{
  std::ostringstream out;
  out.precision(12);
  const double wire = lengthOf(at.path) - 0.5e-3;
  const double catheter = wire - kProtrusion;
  const double begin = 0.9 * kBefore;
  const double catheter_radius = at.clearance < kNarrow ? 0.3e-3 : 0.8e-3;
  out << "name: jam\nduration: 1.0e6\nvessel:\n  tube: {radius: " << catheter_radius + kGap
      << ", facet_length: 1.0e-3, facets_around: 24, pieces: [" << piecesOf(at.path)
      << "]}\n  friction: 0\nentry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n"
      << "instruments:\n"
      << instrumentOf("wire", wire + kOutside + kPushed, kTip, kWireRadius, kStiffness,
                      "    friction: " + std::to_string(at.friction) + "\n    fit_load: 0\n")
      << driveOf(begin, wire, kPushed, at.grip)
      << instrumentOf("catheter", catheter + kOutside, 0.0, catheter_radius, 2e-4,
                      "      kind: catheter\n      inner_radius: " + std::to_string(kWireRadius + at.clearance) + "\n")
      << driveOf(begin - kProtrusion, catheter, 0.0, at.grip)
      << "loads: {damping: 5}\nsampling: {kind: uniform, nodes: 161}\nsolver: {time_step: 0.002}\n";
  return out.str();
}

/** Load at the stop: force of the wall on the wire beyond the catheter, along the last straight part [N]. */
double loadAtStop(const rod::State& state)
{
  const std::vector<Vector3d>& at = state.position;
  const std::size_t last = at.size() - 1;
  Vector3d sum = Vector3d::Zero();
  double from_tip = 0.0;
  std::size_t i = last;
  for (; from_tip < kProtrusion; --i)
  {
    sum += state.wall_force[i];
    from_tip += (at[i] - at[i - 1]).norm();
  }
  const std::size_t straight = last - (last - i) * static_cast<std::size_t>(0.5 * kBeyond / kProtrusion);
  return -sum.dot((at[i] - at[straight]).normalized());
}

/** Force and moment of the wall on the wire beyond the catheter. */
void addEndLoad(const rod::State& state, JamSample& sample)
{
  const std::vector<Vector3d>& at = state.position;
  double from_tip = 0.0;
  std::size_t i = at.size() - 1;
  for (;; --i)
  {
    const double edge = (at[i] - at[i - 1]).norm();
    if (from_tip + edge > sample.protrusion)
      break;
    from_tip += edge;
  }
  const Vector3d tip = at[i] + (sample.protrusion - from_tip) * (at[i - 1] - at[i]).normalized();
  for (; i < at.size(); ++i)
  {
    sample.end_force += state.wall_force[i];
    sample.end_moment += (at[i] - tip).cross(state.wall_force[i]);
  }
}

JamSample sampleOf(const simulation::Simulation& simulation)
{
  JamSample sample;
  const rod::State& state = simulation.state();
  sample.wire = simulation.hand(0).force;
  sample.catheter = simulation.hand(1).force;
  sample.insertion = simulation.hand(0).insertion;
  sample.protrusion = sample.insertion - simulation.hand(1).insertion;
  sample.tip_load = loadAtStop(state);
  addEndLoad(state, sample);
  sample.axis.assign(state.position.begin() + state.first_node, state.position.end());
  return sample;
}

/** Point of the recorded axis. @param s arc length from the mouth of the introducer [m] */
Vector3d pointAt(const JamSample& sample, double s)
{
  std::vector<double> along = {0.0};
  for (std::size_t i = 1; i < sample.axis.size(); ++i)
    along.push_back(along.back() + (sample.axis[i] - sample.axis[i - 1]).norm());
  const double from_begin = along.back() - sample.insertion + s;
  const auto after = std::upper_bound(along.begin() + 1, along.end() - 1, from_begin);
  const auto i = static_cast<std::size_t>(after - along.begin());
  return sample.axis[i - 1] +
         (from_begin - along[i - 1]) / (along[i] - along[i - 1]) * (sample.axis[i] - sample.axis[i - 1]);
}

/** Tube along a smooth line through given points, continued straight at both ends. */
class PathTube : public SmoothWall
{
public:
  PathTube(std::vector<Vector3d> axis, double clearance, double friction)
    : axis_(std::move(axis)), clearance_(clearance), friction_(friction)
  {
    const std::size_t last = axis_.size() - 1;
    for (std::size_t i = 0; i <= last; ++i)
      tangent_.push_back((axis_[std::min(i + 1, last)] - axis_[i > 0 ? i - 1 : 0]).normalized());
  }

protected:
  bool measure(const Vector3d& axis, int face, contact::Feature& feature) const override
  {
    Vector3d tangent;
    Vector3d across = axis - closest(axis, tangent);
    across -= tangent.dot(across) * tangent;
    const double distance = across.norm();
    if (face > 0 || distance < 1e-3 * clearance_)
      return false;
    feature.normal = -across / distance;
    feature.gap = clearance_ - distance;
    feature.point = axis - feature.gap * feature.normal;
    feature.clearance_radius = clearance_;
    feature.friction = friction_;
    return true;
  }

private:
  /** Point of the axis in whose normal plane a point lies: a cubic (Hermite) between two given points. */
  Vector3d closest(const Vector3d& point, Vector3d& tangent) const
  {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < axis_.size(); ++i)
      if ((axis_[i] - point).squaredNorm() < (axis_[nearest] - point).squaredNorm())
        nearest = i;
    const bool behind = tangent_[nearest].dot(point - axis_[nearest]) < 0.0;
    if ((nearest == 0 && behind) || (nearest + 1 == axis_.size() && !behind))
    {
      tangent = tangent_[nearest];
      return axis_[nearest] + tangent.dot(point - axis_[nearest]) * tangent;
    }
    const std::size_t i = behind ? nearest - 1 : nearest;
    const Vector3d chord = axis_[i + 1] - axis_[i];
    const double length = chord.norm();
    const double before = tangent_[i].dot(point - axis_[i]);
    const double after = tangent_[i + 1].dot(axis_[i + 1] - point);
    const double t = std::clamp(before / (before + after), 0.0, 1.0);
    tangent = ((1.0 - t) * tangent_[i] + t * tangent_[i + 1]).normalized();
    return (1.0 - t) * (1.0 - t) * ((1.0 + 2.0 * t) * axis_[i] + t * length * tangent_[i]) +
           t * t * ((3.0 - 2.0 * t) * axis_[i + 1] - (1.0 - t) * length * tangent_[i + 1]);
  }

  std::vector<Vector3d> axis_, tangent_;
  double clearance_;
  double friction_;
};

}  // namespace

std::vector<JamCase> jamCases()
{
  std::vector<JamCase> cases;
  int number = 0;
  for (const double grip : {2.0, 5.0, 20.0, 100.0})
    for (const double friction : {0.0, 0.3})
      for (const JamPath path : {JamPath::kRightAngle, JamPath::kHairpin, JamPath::kS})
      {
        const bool wide = (number++ + (friction > 0.0 ? 1 : 0) + (grip > 10.0 ? 1 : 0)) % 2 == 0;
        std::ostringstream name;
        name << grip << " N, μ " << friction << ", "
             << (path == JamPath::kRightAngle ? "90°"
                 : path == JamPath::kHairpin  ? "180°"
                                              : "S")
             << ", " << (wide ? "0.4" : "0.05") << " mm";
        cases.push_back({name.str(), grip, friction, path, wide ? 4e-4 : 5e-5});
      }
  return cases;
}

JamResult runJam(const JamCase& at)
{
  const scene::Scene scene = scene::parseScene(sceneOf(at), "jam");
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
  contact::Detector detector(vessel.mesh, scene::wallLaw(*scene.vessel));
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &detector);
  rod::EnergyAudit audit;
  simulation.setObserver(&audit);
  JamResult result;
  const double end = 0.1 + (lengthOf(at.path) - 0.5e-3 - 0.9 * kBefore) / kFast + kPushed / kSlow + 0.2;
  while (simulation.time() < end)
  {
    simulation.stepAll(simulation::commandsAt(scene, simulation.time() + scene.solver.time_step));
    result.rejected += !simulation.report().solved;
    const JamSample sample = sampleOf(simulation);
    const double most = std::max(std::abs(sample.wire), std::abs(sample.catheter));
    result.hand_ratio = std::max(result.hand_ratio, most / at.grip);
    result.layer_force = std::max(result.layer_force, most / (2.0 * at.grip));
    result.imbalance =
        std::max(result.imbalance, std::abs(sample.wire + sample.catheter - simulation.state().hand_force));
    const bool slides = simulation.state().layers[0].friction_stretch >= 19.9e-6;
    const bool firm =
        std::max(std::abs(simulation.slipped(0).insertion), std::abs(simulation.slipped(1).insertion)) < kNoSlip;
    if (slides && firm && sample.wire > result.pushed.wire)
      result.pushed = sample;
    result.jammed = sample;
  }
  const rod::EnergyBalance& balance = audit.balance();
  result.unexplained = std::abs(balance.error()) / balance.turnover;
  return result;
}

double forceInRigidTube(const JamCase& at, const JamSample& sample, const JamReference& reference)
{
  if (at.friction == 0.0)
    return sample.tip_load;
  ReferenceRod rod;
  rod.length = sample.insertion + kOutside;
  rod.bending_stiffness = kStiffness;
  rod.torsional_stiffness = kStiffness / 1.3;
  rod.radius = kWireRadius;
  rod.density = 5000.0;
  rod.nodes = static_cast<int>(std::lround(rod.length / reference.edge)) + 1;
  rod::Boundary boundary;
  boundary.guide_length = 8e-3;
  boundary.direction = Vector3d::UnitZ();
  boundary.director = Vector3d::UnitX();
  rod::Environment environment;
  environment.damping = 50.0;
  ReferenceWire wire("kkt", rod, boundary, environment, stiffContactSettings(),
                     sample.insertion - sample.protrusion - reference.travel);
  PathTube tube(sample.axis, at.clearance, at.friction);
  wire.wall = &tube;
  const double outside = rod.length - wire.state.inserted_length;
  for (int i = 0; i < rod.nodes; ++i)
    wire.state.position[i] = pointAt(sample, rod.length * i / (rod.nodes - 1) - outside);
  const Vector3d forward = (sample.axis.back() - sample.axis[sample.axis.size() - 2]).normalized();
  const Vector3d end = sample.axis.back() - sample.protrusion * forward;
  double sum = 0.0;
  double travel = 0.0;
  int count = 0;
  for (double reached = -1.0; reached < 0.0; travel += reference.speed * reference.step)
  {
    const double load = std::min(1.0, travel / reference.ramp) * sample.tip_load;
    wire.input.forces = {{rod.nodes - 1, -load * forward}};
    wire.input.inserted_length += reference.speed * reference.step;
    if (!wire.step(reference.step) || travel > kMostTravel)
      throw std::runtime_error("jam: the reference does not arrive");
    reached = forward.dot(wire.state.position.back() - end);
    if (reached < -kMeasuredTravel)
      continue;
    sum += wire.state.hand_force;
    ++count;
  }
  return sum / count;
}

double staticForceInRigidTube(const JamCase& at, const JamSample& sample, JamMouth mouth, double spacing)
{
  double length = 0.0;
  for (std::size_t i = 1; i < sample.axis.size(); ++i)
    length += (sample.axis[i] - sample.axis[i - 1]).norm();
  const Bore bore = boreAlong(sample.axis, length - sample.insertion, length - sample.protrusion, spacing,
                              {at.clearance, at.friction});
  const Vector3d force = bore.end * sample.end_force;
  const Vector3d couple = bore.end * sample.end_moment.cross(bore.end.row(2).transpose());
  if (mouth == JamMouth::kFree)
    return pushThroughBore(kStiffness, bore, {-force.z()});
  return pushThroughBore(kStiffness, bore, {-force.z(), force.head<2>(), couple.head<2>()});
}

}  // namespace endovascular_sim::benchmark
