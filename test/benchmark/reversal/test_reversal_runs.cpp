#include "benchmark/reversal/reversal_runs.h"

#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/reference/smooth_walls.h"
#include "rod/kkt/kkt_stepper.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kSmallStep = 2e-4;  // s: of the references, at 2 rad/s

ReversalMotion motion(double rate, double time_step, double amplitude)
{
  ReversalMotion motion;
  motion.rate = rate;
  motion.time_step = time_step;
  motion.amplitude = amplitude;
  return motion;
}

TEST(Reversal, InABendTheTorqueDoesNotDependOnTheTimeStep)
{
  const std::unique_ptr<ReversalCase> bend = reversalInBend();
  const ReversalCurve reference = bend->run(motion(2.0, kSmallStep, 1.2));
  for (const auto& [rate, step, tolerance] :
       {std::tuple(0.5, 1e-3, 0.05), std::tuple(2.0, 1e-3, 0.05), std::tuple(6.0, 2e-3, 0.15)})
  {
    const ReversalCurve curve = bend->run(motion(rate, step, 1.2));
    EXPECT_LT(worstDeviation(curve, reference), tolerance) << rate << " " << step;
    EXPECT_NEAR(curve.slidingTorque(), reference.slidingTorque(), 0.01 * reference.slidingTorque()) << rate;
  }
}

TEST(Reversal, InATroughTheTorqueDoesNotDependOnTheTimeStep)
{
  const std::unique_ptr<ReversalCase> trough = reversalInTrough();
  const ReversalCurve reference = trough->run(motion(2.0, kSmallStep, 0.6));
  for (const auto& [rate, step, tolerance] : {std::tuple(2.0, 1e-3, 0.05), std::tuple(6.0, 2e-3, 0.15)})
  {
    const ReversalCurve curve = trough->run(motion(rate, step, 0.6));
    EXPECT_LT(worstDeviation(curve, reference), tolerance) << rate << " " << step;
    EXPECT_NEAR(curve.slidingTorque(), reference.slidingTorque(), 0.01 * reference.slidingTorque()) << rate;
  }
}

/** A wire at the angle φ of the trough rolls without sliding while |tan φ| < μ: its axis moves by r Δθ along a circle
 * of radius c, and the wall exerts the torque w r sin φ per length. Linearised at φ = 0, the twist obeys GJ θ″ = w r²
 * θ/c, and a rotation Δ of the handle changes the torque by Δ √(GJ κ) tanh(L √(κ/GJ)), κ = w r²/c. */
TEST(Reversal, InATroughTheWireRollsAndIsTwistedAsInTheClosedForm)
{
  const double friction = 0.2;
  const double radius = 1.8e-4;
  const double clearance = 2e-4;
  const double weight = 7900.0 * M_PI * radius * radius * 1000.0;  // N/m
  const double ei = 1e-5;
  const double gj = 1e-5;
  const ReversalCurve curve = reversalInTrough()->run(motion(2.0, 1e-3, 0.6));
  const double sliding = curve.slidingTorque();
  // Length on the wall, with a part in the introducer.
  const double length = sliding * std::hypot(1.0, friction) / (friction * radius * weight);
  EXPECT_NEAR(length, 0.155, 0.01);
  const double kappa = weight * radius * radius / clearance;
  const double slope = std::sqrt(gj * kappa) * std::tanh(length * std::sqrt(kappa / gj));
  // The introducer clamps the wire at its mouth: next to it the wire cannot roll, and its friction reverses at once.
  const double clamped = std::pow(ei * clearance / weight, 0.25) / length;
  const std::size_t reversal = curve.angle.size() / 2;
  int rolling = 0;
  for (std::size_t k = reversal; k < curve.angle.size(); ++k)
  {
    const double back = curve.angle[reversal] - curve.angle[k];
    const double expected = sliding - slope * back;
    if (expected < -0.9 * sliding)
      break;
    EXPECT_NEAR(curve.torque[k], expected - clamped * sliding, (0.05 + clamped) * sliding) << back;
    ++rolling;
  }
  EXPECT_GE(rolling, 20);
  EXPECT_NEAR(curve.torque.back(), -sliding, 0.01 * sliding);
}

TEST(Reversal, BothLinearSolversGiveTheSameTorque)
{
  rod::StepperSettings sparse;
  sparse.linear_solver = rod::LinearSolver::kSparse;
  const ReversalCurve expected = reversalInTrough()->run(motion(2.0, 1e-3, 0.1));
  const ReversalCurve curve = reversalInTrough(sparse)->run(motion(2.0, 1e-3, 0.1));
  for (std::size_t k = 0; k < curve.torque.size(); ++k)
    EXPECT_NEAR(curve.torque[k], expected.torque[k], 1e-4 * expected.slidingTorque()) << k;
}

/** Wire that leaves a catheter in the trough; one of the two handles turns. */
class StackInTrough : public ReversalCase
{
public:
  explicit StackInTrough(int turning) : ReversalCase(rod::StepperSettings()), turning_(turning) {}

protected:
  std::unique_ptr<rod::Stepper> makeStepper(const rod::StepperSettings& settings) const override
  {
    rod::Layer wire, catheter;
    wire.wire.sections.push_back(section(1.8e-4, 1e-5));
    catheter.wire.sections.push_back(section(3e-4, 2e-5));
    rod::Boundary boundary;
    boundary.origin.z() = -kClearance;
    rod::Environment environment;
    environment.gravity.z() = -200.0;
    environment.damping = 100.0;
    std::vector<double> position;
    for (int i = 0; i < 101; ++i)
      position.push_back(0.2 * i / 100.0);
    return std::make_unique<rod::KktStepper>(std::vector<rod::Layer>{wire, catheter}, position, boundary, environment,
                                             settings);
  }

  contact::ContactSource& wall() override { return wall_; }

  void prepare(rod::Stepper& stepper, rod::State& state, rod::StepInput& input) override
  {
    input.layers = {{0.15, 0.0}, {0.08, 0.0}};
    state = stepper.initialState(input.layers);
    for (int k = 0; k < 200; ++k)
      advance(stepper, state, input, 1e-3);
  }

  void turnHandle(rod::StepInput& input, double rotation) const override
  {
    input.rotation = rotation;
    input.layers[turning_].rotation = rotation;
  }

  double torque(const rod::State& state) const override { return state.layers[turning_].hand_torque; }

private:
  static rod::Section section(double radius, double stiffness)
  {
    rod::Section section;
    section.length = 0.2;
    section.radius = radius;
    section.density = 7900.0;
    section.bending_stiffness = section.torsional_stiffness = stiffness;
    return section;
  }

  static constexpr double kClearance = 2e-4;  // m
  int turning_;
  Trough wall_{kClearance, 0.2};  ///< of one clearance for both radii
};

TEST(Reversal, OfALayerOfAStackDoesNotDependOnTheTimeStep)
{
  for (const int turning : {0, 1})
  {
    StackInTrough stack(turning);
    const ReversalCurve reference = stack.run(motion(2.0, kSmallStep, 0.6));
    EXPECT_GT(reference.slidingTorque(), 1e-8);
    const ReversalCurve curve = stack.run(motion(2.0, 1e-3, 0.6));
    EXPECT_LT(worstDeviation(curve, reference), 0.05) << turning;
    EXPECT_NEAR(curve.slidingTorque(), reference.slidingTorque(), 0.01 * reference.slidingTorque()) << turning;
  }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
