#include <gtest/gtest.h>

#include "common/units.h"
#include "rod/twist/twist.h"
#include "test/rod/rod_fixtures.h"

// Torque transmission on a prescribed planar centreline : GJ φ″ = EI κ κ0 sin φ, φ between the wire's
// natural bend and the centreline's; φ_in is the handle's angle, φ_out the tip's.

namespace endovascular_sim::rod
{
namespace
{

using units::kDegree;
constexpr double kStiffness = 1e-3;  // EI and GJ of the bend's wire [N·m²]

/** Wire on a planar centreline with equal turning angles at its last nodes, held at the middle of its first edge. */
struct PlanarBend
{
  PlanarBend(const Wire& wire, int nodes, int bent_nodes, double turn) : rod(discretiseUniformly(wire, nodes))
  {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    double angle = 0.0;
    state.position.push_back(x);
    for (int j = 0; j + 1 < nodes; ++j)
    {
      if (j >= nodes - 1 - bent_nodes)
        angle += turn;
      x += rod.rest_length[j] * Eigen::Vector3d(std::cos(angle), 0.0, -std::sin(angle));
      state.position.push_back(x);
    }
    state.twist_angle.assign(static_cast<std::size_t>(nodes - 1), 0.0);
    hold.position = 0.5 * rod.rest_length[0];
  }

  /** Turns the handle to an angle; returns the angle of the tip. */
  double turnTo(double angle)
  {
    hold.rotation = angle;
    twist.solve(rod, hold, state);
    return state.twist_angle.back();
  }

  Discretisation rod;
  State state;
  TwistBoundary hold;
  QuasiStaticTwist twist;
};

/** Pre-curved over the whole bend, √(EI κ κ0/GJ)·L = lambda. The discrete bend reaches from the middle of the first
 *  edge to that of the last. */
PlanarBend distributedBend(double lambda, int nodes)
{
  const double length = 0.1;
  const double edge = length / (nodes - 2);
  const double curvature = lambda / length;
  Wire wire = uniformWire(edge * (nodes - 1), kStiffness, 4e-4, 7000.0);
  wire.sections[0].torsional_stiffness = kStiffness;
  wire.sections[0].rest_curvature = Eigen::Vector2d(0.0, -curvature);
  return PlanarBend(wire, nodes, nodes - 2, 2.0 * std::atan(0.5 * curvature * edge));
}

/** Angle of the handle, turned in small steps, at which the tip first reaches an angle. */
double handAngleFor(PlanarBend& bend, double tip)
{
  const double step = 0.25 * kDegree;
  double before = bend.turnTo(0.0);
  for (double hand = step; hand < 7.0; hand += step)
  {
    const double now = bend.turnTo(hand);
    if (now >= tip)
      return hand - step * (now - tip) / (now - before);
    before = now;
  }
  return NAN;
}

struct Transmission
{
  double lambda;
  double out;     ///< [deg]
  double in;      ///< [deg]
  double torque;  ///< torque at the handle, TL/GJ
};

TEST(ReferencesTwist, HandleAngleForATipAngleInABendIsThatOfTheContinuum)
{
  for (const Transmission& exact : {Transmission{0.5, 60.0, 66.26484711852943, 0.22078327533305434},
                                    Transmission{1.0, 60.0, 85.69151950722886, 0.9218174202195772},
                                    Transmission{1.0, 120.0, 143.65376297895565, 0.7816012694421106},
                                    Transmission{1.0, 165.0, 171.8332525609681, 0.21878306608550602},
                                    Transmission{2.0, 45.0, 138.73427699472361, 3.4161564646369995},
                                    Transmission{2.0, 90.0, 191.78227469332728, 2.7984718770529384},
                                    Transmission{2.5, 60.0, 213.4321912826432, 4.084327434353842}})
  {
    PlanarBend bend = distributedBend(exact.lambda, 80);
    const double hand = handAngleFor(bend, exact.out * kDegree);
    EXPECT_NEAR(hand / kDegree, exact.in, 0.05) << "lambda " << exact.lambda << " out " << exact.out;
    EXPECT_NEAR(bend.turnTo(hand), exact.out * kDegree, 1e-3);
    EXPECT_NEAR(std::abs(bend.state.hand_torque) * 0.1 / kStiffness, exact.torque, 0.003 * exact.torque);
  }
}

TEST(ReferencesTwist, TransmissionConvergesWithSecondOrder)
{
  const auto error = [](int nodes)
  {
    PlanarBend bend = distributedBend(2.0, nodes);
    return handAngleFor(bend, 90.0 * kDegree) / kDegree - 191.78227469332728;
  };
  const double coarse = error(22);
  const double fine = error(42);
  const double finest = error(82);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15);
  EXPECT_NEAR(std::log2(fine / finest), 2.0, 0.15);
}

struct Snap
{
  double hand = NAN;  ///< last angle of the handle before the snap-through [rad]
  double from = NAN;  ///< last angle of the tip before it [rad]
  double to = NAN;
};

/** Turns the handle by steps until the tip snaps through. */
Snap snapOf(PlanarBend& bend, double begin, double step, double end)
{
  double before = bend.turnTo(begin);
  for (int k = 1; k < static_cast<int>((end - begin) / step); ++k)
  {
    const double now = bend.turnTo(begin + k * step);
    if (std::abs(now - before) > 0.5)
      return {begin + (k - 1) * step, before, now};
    before = now;
  }
  return {};
}

TEST(ReferencesTwist, APreCurvedWireSnapsThroughAsTheContinuumAndReachesItsNextState)
{
  struct Exact
  {
    double lambda, in, out, landing;  // [deg]
  };
  for (const Exact& exact : {Exact{2.0, 197.7856142522825, 116.7210068571072, 301.6117828402459},
                             Exact{2.5, 228.97578968967696, 92.41541234603068, 335.325407876718}})
  {
    PlanarBend bend = distributedBend(exact.lambda, 80);
    const Snap forward = snapOf(bend, 0.0, 0.05 * kDegree, 7.0);
    EXPECT_NEAR(forward.hand / kDegree, exact.in, 0.15);
    EXPECT_NEAR(forward.from / kDegree, exact.out, 5.0);  // the slope is infinite at this point
    EXPECT_NEAR(forward.to / kDegree, exact.landing, 0.3);
    // Hysteresis, symmetric about half a turn.
    const Snap back = snapOf(bend, forward.hand + 0.2 * kDegree, -0.05 * kDegree, 0.0);
    EXPECT_NEAR(back.hand / kDegree, 360.0 - exact.in, 0.15);
    EXPECT_NEAR(back.to / kDegree, 360.0 - exact.landing, 0.3);
  }
}

TEST(ReferencesTwist, BelowAQuarterWaveTheTipFollowsTheHandleWithoutASnapThrough)
{
  for (const double lambda : {0.9, 0.98})
  {
    PlanarBend bend = distributedBend(lambda * 0.5 * M_PI, 80);
    EXPECT_TRUE(std::isnan(snapOf(bend, 0.0, 0.05 * kDegree, 7.0).hand)) << lambda;
  }
  PlanarBend bend = distributedBend(1.03 * 0.5 * M_PI, 80);
  EXPECT_NEAR(snapOf(bend, 0.0, 0.05 * kDegree, 7.0).hand, M_PI, 2.0 * kDegree);
}

// A long straight shaft and a short tip, stiff in torsion, in the bend: φ_in − φ_out = A sin φ_out, A = EI κ κ0 l
// L0/GJ.
TEST(ReferencesTwist, ALongShaftWithAShortPreCurvedTipSnapsByTheLumpedFormula)
{
  const int nodes = 801;
  const int bent = 64;
  const double edge = 0.125e-3;
  const double shaft = (nodes - 2 - bent) * edge;  // from the middle of the first edge to the tip's first middle
  const double factor = 2.0;                       // A
  const double curvature = std::sqrt(factor / (bent * edge * shaft));
  Wire wire = uniformWire(shaft + 0.5 * edge, kStiffness, 4e-4, 7000.0);
  wire.sections[0].torsional_stiffness = kStiffness;
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = (bent + 0.5) * edge;
  wire.sections[1].torsional_stiffness = 1e4 * kStiffness;
  wire.sections[1].rest_curvature = Eigen::Vector2d(0.0, -curvature);
  PlanarBend bend(wire, nodes, bent, 2.0 * std::atan(0.5 * curvature * edge));
  const double hand = handAngleFor(bend, 60.0 * kDegree);
  EXPECT_NEAR(hand / kDegree, 159.23920117592255, 0.3);
  const Snap snap = snapOf(bend, hand, 0.05 * kDegree, 7.0);
  EXPECT_NEAR(snap.hand / kDegree, 219.23920117592257, 0.3);
  EXPECT_NEAR(snap.to / kDegree, 308.6866410295673, 0.5);
}

// Null test: a straight isotropic wire turns at its tip exactly as at the handle, in any bend, without torque.
TEST(ReferencesTwist, AStraightWireTransmitsTheHandlesAngleThroughAnyBend)
{
  const int nodes = 60;
  Boundary boundary = clampAtOrigin(0.2, nodes);
  Environment environment;
  environment.damping = 50.0;
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(0.2, nodes), kStiffness, 4e-4, 7000.0), nodes),
                     boundary, environment, StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({nodes - 1, Eigen::Vector3d(0.0, 0.2, 0.0)});
  input.forces.push_back({nodes / 2, Eigen::Vector3d(0.0, 0.0, -0.4)});
  PhaseTimer timer;
  for (int k = 0; k < 500; ++k)
  {
    std::uint32_t pass = 0;
    input.rotation = 0.02 * k;
    ASSERT_TRUE(stepper.step(state, input, 1e-3, pass, nullptr, timer).solved);
  }
  ASSERT_GT(state.position.back().norm(), 0.05);
  ASSERT_LT(state.position.back().x(), 0.18);
  EXPECT_NEAR(state.twist_angle.back(), state.rotation, 1e-9);
  EXPECT_EQ(state.hand_torque, 0.0);
  // The twist solver gives the same result when it solves this case.
  TwistBoundary hold;
  hold.position = 0.5 * stepper.discretisation().rest_length[0];
  hold.rotation = state.rotation;
  QuasiStaticTwist twist;
  twist.solve(stepper.discretisation(), hold, state);
  EXPECT_NEAR(state.twist_angle.back(), state.rotation, 1e-9);
  EXPECT_NEAR(state.hand_torque, 0.0, 1e-15);
}

// A freely rotating bent tip exerts no torque. Positions that are solved at a fixed twist would lag behind the handle,
// and the hand would feel a good part of EI κ̄² ℓ times the rotation of a step.
TEST(ReferencesTwist, TorqueOfAnUnloadedRotatingTipIsOfSecondOrderInTheTimeStep)
{
  constexpr double kRate = 4.0;        // rad/s
  constexpr double kCurvature = 80.0;  // 1/m
  const int nodes = 60;
  Wire wire = uniformWire(clampedLength(0.05, nodes), kStiffness, 4e-4, 7000.0);
  Section tip = wire.sections.front();
  tip.length = 0.01;
  wire.sections.front().length -= tip.length;
  tip.rest_curvature = Eigen::Vector2d(kCurvature, 0.0);
  wire.sections.push_back(tip);
  KktStepper stepper(discretiseUniformly(wire, nodes), clampAtOrigin(0.05, nodes), Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  PhaseTimer timer;
  double coarser = 0.0;
  for (const double dt : {2e-3, 1e-3})
  {
    for (int k = 0; k < 1000; ++k)
    {
      std::uint32_t pass = 0;
      input.rotation += kRate * dt;
      ASSERT_TRUE(stepper.step(state, input, dt, pass, nullptr, timer).solved);
    }
    const double of_a_step = kStiffness * kCurvature * kCurvature * tip.length * kRate * dt;
    EXPECT_LT(std::abs(state.hand_torque), 1e-3 * of_a_step) << dt;
    if (dt == 1e-3)
    {
      EXPECT_GT(std::abs(coarser / state.hand_torque), 3.8) << "second order in the step";
    }
    coarser = state.hand_torque;
  }
}

// Over one turn of a helix (radius 1, pitch 2π·0.5) the Bishop frame falls behind Frenet's by 2.8099
// rad, in a polygon of 16, 64 edges by 2.8537, 2.8126. With equal directors at both ends that angle is twist.
TEST(ReferencesTwist, TransportAlongAHelixTurnsByItsTorsion)
{
  for (const auto& [edges, torsion] : {std::make_pair(16, 2.853683510031414), std::make_pair(64, 2.8126358328821897)})
  {
    const int nodes = edges + 2;  // the last edge is parallel to the first one
    std::vector<Eigen::Vector3d> position;
    for (int i = 0; i < nodes; ++i)
    {
      const double t = 2.0 * M_PI * i / edges;
      position.emplace_back(0.01 * std::cos(t), 0.01 * std::sin(t), 0.005 * t);
    }
    const double edge = (position[1] - position[0]).norm();
    Discretisation rod = discretiseUniformly(uniformWire(edge * (nodes - 1), kStiffness, 4e-4, 7000.0), nodes);
    State state;
    state.position = position;
    state.twist_angle.assign(static_cast<std::size_t>(nodes - 1), 0.0);
    TwistBoundary hold;
    hold.position = 0.5 * edge;
    hold.tangent = (position[1] - position[0]) / edge;
    hold.director = hold.tangent.cross(Eigen::Vector3d::UnitZ()).normalized();
    hold.tip_held = true;
    hold.tip_director = hold.director;
    QuasiStaticTwist twist;
    twist.solve(rod, hold, state);
    EXPECT_NEAR(std::abs(state.tip_transport), torsion, 1e-9);
    EXPECT_NEAR(std::abs(state.distal_torque), (kStiffness / 1.3) * torsion / (edges * edge), 1e-9);
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
