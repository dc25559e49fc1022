#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/units.h"
#include "contact/detector.h"
#include "motion/contact/moving_wall.h"
#include "rod/energy/energy_audit.h"
#include "test/rod/rod_fixtures.h"
#include "vessel/anatomy/tube.h"

// A rod in a vessel that moves by a map: rigid motion, slow growth, and many beats.

namespace endovascular_sim
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;
using motion::MotionMap;

constexpr double kDt = 1e-3;  // s
constexpr int kNodes = 61;

/** Tube of 4 mm with a bend of 40 mm radius, along z from the origin. */
vessel::TubeShape bentTube()
{
  vessel::TubeShape shape;
  shape.radius = 2e-3;
  shape.facet_length = 1e-3;
  shape.facets_around = 48;
  shape.pieces = {{0.01, 0.0, 0.0}, {0.05, 25.0, 0.4}, {0.02, 0.0, 0.0}};
  return shape;
}

/** Point of the tube's axis. @param arc from the origin [m] */
Vector3d axisAt(double arc)
{
  const double into_bend = std::clamp(arc - 0.01, 0.0, 0.05);
  const double beyond = std::max(0.0, arc - 0.06);
  const Vector3d side(std::cos(0.4), std::sin(0.4), 0.0);
  const double angle = 25.0 * into_bend;
  const Vector3d straight(0.0, 0.0, std::min(arc, 0.01));
  const Vector3d bend = 0.04 * ((1.0 - std::cos(angle)) * side + std::sin(angle) * Vector3d::UnitZ());
  return straight + bend + beyond * (std::sin(angle) * side + std::cos(angle) * Vector3d::UnitZ());
}

struct BenchSettings
{
  double bending_stiffness = 2e-7;  // N·m²
  double friction = 0.3;
  double damping = 0.0;     // 1/s
  double density = 6000.0;  // kg/m³
  rod::EndHold proximal = rod::EndHold::kFree;
};

/** Wire on the axis of a tube whose wall moves. */
class Bench
{
public:
  explicit Bench(const BenchSettings& settings, const geometry::TriangleMesh& mesh = vessel::tubeMesh(bentTube()))
    : detector_(mesh, law(settings.friction)),
      wall_(&detector_, motion::mapBounds(MotionMap({}, {}, {}), {Vector3d::Zero()})),
      stepper_(
          rod::discretiseUniformly(rod::uniformWire(0.06, settings.bending_stiffness, 2e-4, settings.density), kNodes),
          boundary(settings.proximal), environment(settings.damping), rod::StepperSettings()),
      state_(stepper_.initialState(0.0, 0.0))
  {
    stepper_.setObserver(&audit_);
    for (int i = 0; i < kNodes; ++i)
      state_.position[i] = axisAt(0.005 + 0.06 * i / (kNodes - 1));
    stepper_.invalidateContacts();
  }

  /** Bounds of the maps to come. */
  void setBounds(const motion::MapBounds& bounds) { bounds_ = bounds, wall_ = motion::MovingWall(&detector_, bounds); }

  void step(const MotionMap& from, const MotionMap& to, const std::vector<rod::NodalForce>& forces = {})
  {
    rod::StepInput input;
    input.forces = forces;
    wall_.beginStep(from, to);
    if (wall_.moves())
      input.wall = &wall_;
    input.step = steps_++;
    std::uint32_t pass = 0;
    const rod::StepReport report = stepper_.step(state_, input, kDt, pass, &wall_, timer_);
    solves_ += report.solves;
    EXPECT_TRUE(report.solved);
  }

  Vector3d sumOfWallForces() const
  {
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& force : state_.wall_force)
      sum += force;
    return sum;
  }

  rod::State& state() { return state_; }
  const rod::Discretisation& rod() const { return stepper_.discretisation(); }
  const rod::EnergyBalance& balance() const { return audit_.balance(); }
  rod::Energy energy() { return stepper_.energy(state_); }
  const contact::Detector& detector() const { return detector_; }
  int solves() const { return solves_; }

private:
  static contact::WallLaw law(double friction)
  {
    contact::WallLaw law;
    law.friction = friction;
    return law;
  }
  static rod::Boundary boundary(rod::EndHold hold)
  {
    rod::Boundary boundary;
    boundary.introducer = false;
    boundary.proximal = hold;
    boundary.origin = axisAt(0.005);
    boundary.direction = Vector3d::UnitZ();
    boundary.director = Vector3d::UnitX();
    return boundary;
  }
  static rod::Environment environment(double damping)
  {
    rod::Environment environment;
    environment.damping = damping;
    return environment;
  }

  contact::Detector detector_;
  motion::MapBounds bounds_;
  motion::MovingWall wall_;
  rod::KktStepper stepper_;
  rod::State state_;
  rod::EnergyAudit audit_;
  PhaseTimer timer_;
  std::uint64_t steps_ = 0;
  int solves_ = 0;
};

MotionMap restingMap()
{
  return {{}, {}, {}};
}

// ------------------------------------------------------------------------------------------------------ rigid motion

/** Rigid motion of all space: a shift of 10 mm and a rotation of 0.3 rad, three times a second. */
struct RigidMotion
{
  Vector3d axis = Vector3d(0.3, -0.5, 0.8).normalized();
  Vector3d way{6e-3, -4e-3, 7e-3};

  Matrix3d rotation(double t) const
  {
    return Eigen::AngleAxisd(0.3 * (1.0 - std::cos(2.0 * units::kPi * 3.0 * t)), axis).toRotationMatrix();
  }
  Vector3d shift(double t) const { return (1.0 - std::cos(2.0 * units::kPi * 3.0 * t)) * way; }

  MotionMap map(double t) const
  {
    motion::HeartFrame frame;
    frame.fade.core = 1e3;
    frame.fade.reach = 2e3;
    motion::MotionField field;
    field.shift = shift(t);
    field.linear = rotation(t) - Matrix3d::Identity();
    return {frame, field, {}};
  }

  /** Force of inertia in the moving frame that the motion of the frame adds in a step of backward Euler [N].
   *  @param now, before positions in the frame at the beginning of the step, and a step earlier [m] */
  Vector3d inertia(double mass, const Vector3d& now, const Vector3d& before, double t) const
  {
    const auto inSpace = [this](const Vector3d& rest, double s) -> Vector3d { return rotation(s) * rest + shift(s); };
    const Vector3d past = shift(t) - 2.0 * inSpace(now, t - kDt) + inSpace(before, t - 2.0 * kDt);
    return -mass / (kDt * kDt) * (rotation(t).transpose() * past + 2.0 * now - before);
  }
};

/** Root mean squares over a motion of 0.7 s, relative to the magnitudes of all wall forces [1]. */
struct RigidComparison
{
  double error = 0.0;    ///< of the sum of the wall forces in the moving frame
  double inertia = 0.0;  ///< change of that sum by the forces of inertia
  double way = 0.0;      ///< largest difference of the positions [m]
};

/** Compares a wire in a tube that moves as a rigid body with one in a tube at rest, under the forces of inertia. */
RigidComparison compareRigidMotion(const BenchSettings& settings)
{
  Bench moving(settings), resting(settings);
  for (int k = 0; k < 500; ++k)
  {
    moving.step(restingMap(), restingMap());
    resting.step(restingMap(), restingMap());
  }
  const Vector3d at_rest = resting.sumOfWallForces();
  const RigidMotion rigid;
  std::vector<Vector3d> before = resting.state().position;
  RigidComparison result;
  double errors = 0.0, changes = 0.0, sums = 0.0;
  for (int k = 1; k <= 700; ++k)
  {
    const double t = k * kDt;
    std::vector<rod::NodalForce> inertia;
    for (int i = 0; i < kNodes; ++i)
      inertia.push_back({i, rigid.inertia(resting.rod().mass[i], resting.state().position[i], before[i], t)});
    before = resting.state().position;
    moving.step(rigid.map(t - kDt), rigid.map(t));
    resting.step(restingMap(), restingMap(), inertia);
    double all = 0.0;
    for (int i = 0; i < kNodes; ++i)
    {
      all += resting.state().wall_force[i].norm();
      result.way = std::max(result.way,
                            (rigid.map(t).pullBack(moving.state().position[i]) - resting.state().position[i]).norm());
    }
    const Vector3d in_frame = rigid.rotation(t).transpose() * moving.sumOfWallForces();
    errors += (in_frame - resting.sumOfWallForces()).squaredNorm();
    changes += (resting.sumOfWallForces() - at_rest).squaredNorm();
    sums += all * all;
  }
  result.error = std::sqrt(errors / sums);
  result.inertia = std::sqrt(changes / sums);
  std::printf("error %.2g, inertia %.2g of all wall forces; positions %.2g m\n", result.error, result.inertia,
              result.way);
  return result;
}

TEST(RodInAMovingWall, FeelsInARigidMotionTheForcesOfARestingVessel)
{
  BenchSettings settings;  // guidewire
  settings.bending_stiffness = 1e-5;
  settings.damping = 30.0;
  const RigidComparison guidewire = compareRigidMotion(settings);
  EXPECT_LT(guidewire.error, 0.002);
  EXPECT_LT(guidewire.way, 1e-6);
}

TEST(RodInAMovingWall, FeelsInARigidMotionTheForcesOfInertia)
{
  BenchSettings settings;  // a wire that is heavy enough for its inertia to be seen
  settings.bending_stiffness = 1e-5;
  settings.density = 1e5;
  settings.friction = 0.1;
  settings.damping = 30.0;
  const RigidComparison heavy = compareRigidMotion(settings);
  EXPECT_GT(heavy.inertia, 0.03);
  EXPECT_LT(heavy.error, 0.01);
  EXPECT_LT(heavy.way, 5e-6);
}

// ------------------------------------------------------------------------------------------------------- slow growth

/** Deformation of the tube's bend that leaves its clamped end in place. */
MotionMap grownMap(double share)
{
  motion::HeartFrame frame;
  frame.base = axisAt(0.045);
  frame.axis = Vector3d(0.6, 0.0, 0.8);
  frame.length = 0.05;
  frame.fade.centre = axisAt(0.05);
  frame.fade.core = 0.005;
  frame.fade.reach = 0.04;
  motion::MotionField field;
  field.shift = share * Vector3d(-2e-3, 1.5e-3, 1e-3);
  field.linear = share * (Matrix3d() << -0.1, 0.04, 0.0, 0.03, 0.05, -0.05, 0.06, 0.0, -0.08).finished();
  field.twist = share * 2.0;
  return {frame, field, {}};
}

TEST(RodInAMovingWall, EndsASlowDeformationInTheStaticsOfTheDeformedMesh)
{
  BenchSettings settings;
  settings.bending_stiffness = 2e-5;
  settings.friction = 0.0;
  settings.damping = 50.0;
  settings.proximal = rod::EndHold::kClamped;
  Bench grown(settings);
  grown.setBounds(motion::mapBounds(grownMap(1.0), motion::gridOf(grownMap(1.0).frame().fade, 2e-3)));
  for (int k = 0; k < 300; ++k)
    grown.step(restingMap(), grownMap(0.0));
  const int steps = 1000;
  for (int k = 1; k <= steps + 1500; ++k)
    grown.step(grownMap(std::min(1.0, (k - 1.0) / steps)), grownMap(std::min(1.0, 1.0 * k / steps)));

  geometry::TriangleMesh mesh = vessel::tubeMesh(bentTube());
  for (Vector3d& vertex : mesh.vertices)
    vertex = grownMap(1.0).position(vertex);
  Bench deformed(settings, mesh);
  deformed.state() = grown.state();
  for (int k = 0; k < 1500; ++k)
    deformed.step(restingMap(), restingMap());

  double total = 0.0, largest = 0.0, way = 0.0;
  for (int i = 0; i < kNodes; ++i)
  {
    total += deformed.state().wall_force[i].norm();
    largest = std::max(largest, deformed.state().wall_force[i].norm());
    way = std::max(way, (deformed.state().position[i] - grown.state().position[i]).norm());
  }
  double before = 0.0;
  for (int i = 0; i < kNodes; ++i)
    before += grown.state().wall_force[i].norm();
  std::printf(
      "sum of magnitudes %.4g N in the moved vessel, %.4g N in the deformed mesh, largest %.3g N; positions %.3g m\n",
      before, total, largest, way);
  EXPECT_GT(total, 0.02);
  EXPECT_NEAR(before, total, 0.02 * total);
  EXPECT_LT(way, 30e-6);
}

// --------------------------------------------------------------------------------------------------------- many beats

TEST(RodInAMovingWall, KeepsItsEnergyBoundedForAHundredBeatsAndTheAuditCloses)
{
  BenchSettings settings;
  settings.bending_stiffness = 2e-5;
  settings.friction = 0.2;
  settings.damping = 5.0;
  settings.proximal = rod::EndHold::kClamped;
  Bench bench(settings);
  bench.setBounds(motion::mapBounds(grownMap(1.0), motion::gridOf(grownMap(1.0).frame().fade, 2e-3)));
  const int beat = 667;
  const auto share = [](int k) { return 0.5 - 0.5 * std::cos(2.0 * units::kPi * k / beat); };
  double first = 0.0, last = 0.0, deepest = -1.0;
  for (int k = 1; k <= 100 * beat; ++k)
  {
    bench.step(grownMap(share(k - 1)), grownMap(share(k)));
    const rod::Energy energy = bench.energy();
    const double kinetic = rod::kineticEnergy(bench.rod(), bench.state());
    if (k <= 10 * beat)
      first = std::max(first, energy.bending + energy.twist + kinetic);
    if (k > 90 * beat)
      last = std::max(last, energy.bending + energy.twist + kinetic);
    if (k % 50 == 0)
      for (int i = 0; i < kNodes; ++i)
        deepest =
            std::max(deepest, -bench.detector().signedDistance(grownMap(share(k)).pullBack(bench.state().position[i])));
  }
  const rod::EnergyBalance& balance = bench.balance();
  std::printf(
      "largest energy %.4g J in the first ten beats, %.4g J in the last ten; work of the wall %.4g J, turnover %.4g J, "
      "closing error %.2g J; %.2f solves per step\n",
      first, last, balance.wall_motion, balance.turnover, balance.error(), bench.solves() / (100.0 * beat));
  EXPECT_LT(last, 1.05 * first);
  EXPECT_LT(deepest, 0.0) << "a node outside";
  EXPECT_GT(std::abs(balance.wall_motion), 1e-6);
  EXPECT_LT(std::abs(balance.error()), 1e-3 * balance.turnover);
  // Without the work of the wall it does not close.
  EXPECT_GT(std::abs(balance.error() - balance.wall_motion), 1e-2 * balance.turnover);
}

}  // namespace
}  // namespace endovascular_sim
