#include "rod/contact/wall_friction.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "rod/kkt/kkt_stepper.h"
#include "rod/mixed/mixed_stepper.h"
#include "rod/paper/paper_stepper.h"
#include "rod/sampling/resampling.h"
#include "test/rod/node_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kFriction = 0.2;
constexpr double kGravity = 9.81;  // m/s²
constexpr double kRadius = 1.8e-4;
const double kSlip = StepperSettings().friction_slip;

enum class Scheme
{
  kKkt,
  kMixed,
  kPaper
};

/** A wire that lies along x on the plane z = 0, which can be tilted about y. */
class Table
{
public:
  Table(Scheme scheme, int nodes, double dt)
    : scheme_(scheme), nodes_(nodes), dt_(dt), wire_(uniformWire(0.1, 4.9469e-5, kRadius, 7900.0)), wall_(kFriction)
  {
    tilt(0.0);
    state = stepper->initialState(0.0, 0.0);
    run(0.2);
  }

  /** @param slope tangent of the angle, downhill along x */
  void tilt(double slope)
  {
    Boundary boundary;
    boundary.introducer = false;
    boundary.origin = Vector3d(0.0, 0.0, kRadius);
    Environment environment;
    const double angle = std::atan(slope);
    environment.gravity = kGravity * Vector3d(std::sin(angle), 0.0, -std::cos(angle));
    const Discretisation rod = discretiseUniformly(wire_, nodes_);
    if (scheme_ == Scheme::kKkt)
      stepper = std::make_unique<KktStepper>(rod, boundary, environment, StepperSettings());
    else if (scheme_ == Scheme::kMixed)
      stepper = std::make_unique<MixedStepper>(wire_, rod, boundary, environment, StepperSettings());
    else
      stepper = std::make_unique<PaperStepper>(rod, boundary, environment, StepperSettings());
  }

  /** Tilts slowly enough for the wire to stay at rest. */
  void tiltTo(double slope)
  {
    for (const double share : {0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 1.0})
    {
      tilt(share * slope);
      run(0.05);
    }
  }

  /** @param push force along x over the wire's weight */
  void step(double push = 0.0)
  {
    StepInput input;
    input.step = steps_++;
    const Discretisation& rod = stepper->discretisation();
    for (int i = 0; push != 0.0 && i < rod.nodes(); ++i)
      input.forces.push_back({i, Vector3d(push * kGravity * rod.mass[i], 0.0, 0.0)});
    std::uint32_t pass = 0;
    PhaseTimer timer;
    report.add(stepper->step(state, input, dt_, pass, &wall_, timer));
  }

  void run(double seconds)
  {
    for (int k = static_cast<int>(std::lround(seconds / dt_)); k > 0; --k)
      step();
  }

  /** Position of the middle node along x [m]. */
  double middle() const { return state.position[static_cast<std::size_t>(nodes_ / 2)].x(); }

  double kineticEnergy() const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < state.velocity.size(); ++i)
      sum += 0.5 * stepper->discretisation().mass[i] * state.velocity[i].squaredNorm();
    return sum;
  }

  std::unique_ptr<Stepper> stepper;
  State state;
  StepReport report;

private:
  Scheme scheme_;
  int nodes_;
  double dt_;
  Wire wire_;
  PlaneWall wall_;
  std::uint64_t steps_ = 0;
};

struct Incline
{
  Scheme scheme;
  double dt;
  double seconds;
};

class InclineTest : public ::testing::TestWithParam<Incline>
{
};

TEST_P(InclineTest, HoldsAWireJustBelowTheAngleOfFriction)
{
  Table table(GetParam().scheme, 21, GetParam().dt);
  table.tiltTo(0.999 * kFriction);
  const double before = table.middle();
  table.run(GetParam().seconds);
  EXPECT_LT(std::abs(table.middle() - before), 1e-9);
}

TEST_P(InclineTest, LetsAWireSlideJustAboveTheAngleOfFriction)
{
  Table table(GetParam().scheme, 21, GetParam().dt);
  table.tiltTo(0.999 * kFriction);
  table.tilt(1.001 * kFriction);
  const double before = table.middle();
  table.run(2.0);
  const double acceleration = 0.001 * kFriction * kGravity * std::cos(std::atan(kFriction));
  // With one solve per step and secants only, `paper` starts late.
  const double tolerance = GetParam().scheme == Scheme::kPaper ? 0.2 : 0.005;
  EXPECT_NEAR(table.middle() - before, 0.5 * acceleration * 4.0, tolerance * 0.5 * acceleration * 4.0);
}

INSTANTIATE_TEST_SUITE_P(WallFriction, InclineTest,
                         ::testing::Values(Incline{Scheme::kKkt, 2.5e-4, 1.0}, Incline{Scheme::kKkt, 1e-3, 10.0},
                                           Incline{Scheme::kKkt, 2e-3, 10.0}, Incline{Scheme::kMixed, 1e-3, 10.0},
                                           Incline{Scheme::kPaper, 2.5e-4, 1.0}));

struct StickSlip
{
  double farthest = 0.0;  // m
  double end = 0.0;       // m
};

/** Push 1.3 μ m g sin(2πt/0.5 s) over one period: the wire sticks, slides, sticks, slides back. */
StickSlip stickSlip(Scheme scheme, int nodes, double dt)
{
  Table table(scheme, nodes, dt);
  const double begin = table.middle();
  StickSlip result;
  const int steps = static_cast<int>(std::lround(0.5 / dt));
  for (int k = 1; k <= steps; ++k)
  {
    table.step(1.3 * kFriction * std::sin(2.0 * M_PI * k / steps));
    result.farthest = std::max(result.farthest, table.middle() - begin);
  }
  result.end = table.middle() - begin;
  return result;
}

TEST(WallFriction, StickSlipDependsNeitherOnTheTimeStepNorOnTheSampling)
{
  // A rigid body on a dry plane, integrated with steps of 1 µs.
  constexpr double kFarthest = 4.0666867e-3;
  for (const double dt : {2.5e-4, 5e-4, 1e-3, 2e-3})
  {
    const StickSlip result = stickSlip(Scheme::kKkt, 21, dt);
    EXPECT_NEAR(result.farthest, kFarthest, 2e-3 * kFarthest) << dt;
    EXPECT_NEAR(result.end, 0.0, 1e-6) << dt;
  }
  for (const int nodes : {11, 41})
    EXPECT_NEAR(stickSlip(Scheme::kKkt, nodes, 1e-3).farthest, kFarthest, 2e-3 * kFarthest) << nodes;
  EXPECT_NEAR(stickSlip(Scheme::kMixed, 21, 1e-3).farthest, kFarthest, 2e-3 * kFarthest);
}

TEST(WallFriction, NeverAddsEnergy)
{
  // A moving wire on the table: its elastic and kinetic energy may only decrease.
  for (const double dt : {2.5e-4, 1e-3, 2e-3})
  {
    Table table(Scheme::kKkt, 41, dt);
    for (std::size_t i = 0; i < table.state.velocity.size(); ++i)
      table.state.velocity[i] = Vector3d(0.2, 0.4 * std::sin(0.3 * static_cast<double>(i)), 0.0);
    const auto energy = [&table]
    {
      const Energy elastic = table.stepper->energy(table.state);
      return table.kineticEnergy() + elastic.bending + elastic.twist + elastic.stretch;
    };
    double least = energy();
    double largest_gain = 0.0;
    const double first = least;
    for (int k = 0; k < 600; ++k)
    {
      table.step();
      largest_gain = std::max(largest_gain, energy() - least);
      least = std::min(least, energy());
    }
    EXPECT_LT(largest_gain, 1e-5 * first) << dt;
    EXPECT_LT(table.kineticEnergy(), 1e-12 * first) << dt;  // it sticks in the end
  }
}

/** Tension ratio T2/T1 of a wire that is pulled back into an introducer over a frictional cylinder. The tension T1 at
 *  its tip is turned by an angle. */
double capstan(double friction, double degrees, double stiffness, double expected)
{
  constexpr double kBend = 20e-3;  // R of the wire's axis [m]
  constexpr double kEi = 5e-5;
  constexpr double kEdge = 0.5e-3;
  constexpr double kDt = 1e-3;
  const double angle = degrees * M_PI / 180.0;
  const double tension = kEi / (stiffness * kBend * kBend);
  const double decay = std::sqrt(kEi / tension);  // decay length of the bending of the free spans [m]
  const double before = 6.0 * decay + 20e-3;
  const double inserted = before + kBend * angle + 8.0 * decay + 24e-3;
  const double length = inserted + 30e-3;
  Boundary boundary;
  // The free span's asymptote lies EI/(2 T R) further out than the wire on the cylinder.
  boundary.origin = Vector3d(-before, kBend + kEi / (2.0 * expected * tension * kBend), 0.0);
  Environment environment;
  environment.damping = 200.0;
  const int nodes = static_cast<int>(std::lround(length / kEdge)) + 1;
  KktStepper stepper(discretiseUniformly(uniformWire(length, kEi, kRadius, 7900.0), nodes), boundary, environment,
                     StepperSettings());
  CylinderWall wall(kBend - kRadius, friction);
  State state = stepper.initialState(inserted, 0.0);
  PhaseTimer timer;
  StepInput input;
  double sum = 0.0;
  for (int k = 1; k <= 2000; ++k)
  {
    const double turned = angle * std::min(1.0, k / 800.0);
    input.step = static_cast<std::uint64_t>(k);
    input.inserted_length = inserted - 4e-3 * kDt * std::max(0, k - 1000);
    input.forces = {{nodes - 1, tension * Vector3d(std::cos(turned), -std::sin(turned), 0.0)}};
    std::uint32_t pass = 0;
    stepper.step(state, input, kDt, pass, &wall, timer);
    if (k > 1500)
      sum -= state.hand_force;
  }
  return sum / (500.0 * tension);
}

struct Capstan
{
  double friction;
  double degrees;
  double stiffness;  // EI/(T1 R²)
  double ratio;      // reference 08, (c)
};

class CapstanTest : public ::testing::TestWithParam<Capstan>
{
};

TEST_P(CapstanTest, WithBendingStiffnessHasTheReferenceTensionRatio)
{
  const Capstan& c = GetParam();
  EXPECT_NEAR(capstan(c.friction, c.degrees, c.stiffness, c.ratio), c.ratio, 1e-3 * c.ratio);
}

INSTANTIATE_TEST_SUITE_P(
    WallFriction, CapstanTest,
    ::testing::Values(Capstan{0.05, 45.0, 0.1, 1.039113872}, Capstan{0.05, 180.0, 0.1, 1.1626729956},
                      Capstan{0.1, 90.0, 0.1, 1.1637334509}, Capstan{0.2, 90.0, 0.01, 1.3673423363},
                      Capstan{0.3, 45.0, 0.01, 1.2644789171}, Capstan{0.3, 90.0, 0.1, 1.5773414788},
                      Capstan{0.3, 180.0, 0.1, 2.4917627567}));

/** A state with one free node per stretch, pressed on a floor. */
State pressedState(const std::vector<Vector3d>& stretch)
{
  State state;
  for (const Vector3d& u : stretch)
  {
    state.position.emplace_back(0.0, 0.0, 0.0);
    state.velocity.emplace_back(0.0, 0.0, 0.0);
    state.wall_force.emplace_back(0.0, 0.0, 2.0);
    state.friction_coefficient.push_back(0.3);
    state.friction_stretch.push_back(u);
  }
  return state;
}

TEST(WallFriction, LinearisedPullIsCoulombsLawWithAStiffnessBetweenTangentAndSecant)
{
  const std::vector<double> mass(3, 1e-6);
  State state = pressedState({Vector3d(0.2e-6, 0.1e-6, 0.0), Vector3d(0.4e-6, 0.0, 0.0), Vector3d(0.0, 0.3e-6, 0.0)});
  const WallFriction::Motion begin = state.position;
  state.position[1] += Vector3d(3e-6, 4e-6, 1e-6);
  state.position[2] += Vector3d(-40e-6, 0.0, 0.0);
  WallFriction friction(kSlip);
  friction.collect(state, begin, &mass, 1e-3, false);
  friction.linearise();
  ASSERT_EQ(friction.count(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
  {
    Vector3d u = state.friction_stretch[k] + state.position[k] - begin[k];
    u.z() = 0.0;
    const auto law = [](const Vector3d& at) { return Vector3d((0.3 * 2.0 / std::max(at.norm(), kSlip)) * at); };
    EXPECT_LT((friction.term(k).pull - law(u)).norm(), 1e-12) << k;
    // Between Newton's tangent, by finite differences, and the secant.
    for (const Vector3d& axis : {Vector3d(1.0, 0.0, 0.0), Vector3d(0.0, 1.0, 0.0), Vector3d(0.6, 0.8, 0.0)})
    {
      const double step = 1e-10;
      const double tangent = axis.dot(law(u + step * axis) - law(u - step * axis)) / (2.0 * step);
      const double stiffness = axis.dot(friction.term(k).stiffness * axis);
      EXPECT_GE(stiffness, (1.0 - 1e-6) * tangent - 1e-3) << k;
      EXPECT_LE(stiffness, (1.0 + 1e-6) * 0.6 / std::max(u.norm(), kSlip)) << k;
    }
    EXPECT_LT((friction.term(k).stiffness * Vector3d::UnitZ()).norm(), 1e-9) << k;
  }
}

TEST(WallFriction, ReturnMappingLimitsTheStretchAndClearsItWithoutAContact)
{
  State state = pressedState({Vector3d(0.1e-6, 0.0, 0.0), Vector3d(0.4e-6, 0.0, 0.0), Vector3d(0.4e-6, 0.0, 0.0)});
  const WallFriction::Motion begin = state.position;
  state.position[0] += Vector3d(0.2e-6, 0.0, 5e-6);
  state.position[1] += Vector3d(0.0, 30e-6, 0.0);
  state.wall_force[2].setZero();
  WallFriction(kSlip).finish(state, begin);
  EXPECT_LT((state.friction_stretch[0] - Vector3d(0.3e-6, 0.0, 0.0)).norm(), 1e-18);
  EXPECT_NEAR(state.friction_stretch[1].norm(), kSlip, 1e-18);
  EXPECT_GT(state.friction_stretch[1].y(), 0.99 * kSlip);
  EXPECT_TRUE(state.friction_stretch[2].isZero(0.0));
  EXPECT_NEAR(frictionForce(state, 1, kSlip).norm(), 0.6, 1e-12);
}

TEST(WallFriction, ARestingWireContinuesFromItsStateBitForBit)
{
  Table table(Scheme::kKkt, 21, 1e-3);
  table.tiltTo(0.9 * kFriction);
  const State saved = table.state;
  table.run(0.05);
  const std::uint64_t first = table.state.hash();
  table.state = saved;
  table.stepper->invalidateContacts();
  table.run(0.05);
  EXPECT_EQ(table.state.hash(), first);
}

TEST(WallFriction, AStickingWireStaysAtItsPositionWhenItIsResampled)
{
  const Wire wire = uniformWire(0.1, 4.9469e-5, kRadius, 7900.0);
  Table table(Scheme::kKkt, 21, 1e-3);
  table.tiltTo(0.9 * kFriction);
  const double before = table.middle();
  const Discretisation coarse = discretiseUniformly(wire, 21);
  const Discretisation fine = discretiseUniformly(wire, 41);
  Resampling resampling;
  for (int k = 0; k < 20; ++k)
  {
    const bool split = k % 2 == 0;
    resampling.carry(wire, split ? coarse : fine, split ? fine : coarse, table.state);
    ASSERT_TRUE(table.stepper->resample(split ? fine : coarse));
    table.run(0.05);
  }
  EXPECT_LT(std::abs(table.middle() - before), 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::rod
