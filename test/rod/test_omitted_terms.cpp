#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

// Terms that a scene does not need are not computed. Two proofs: the number of entries into a phase, and properties of
// NaN, which would spread to every node if a term used them.

namespace endovascular_sim::rod
{
namespace
{

constexpr int kNodes = 30;

/** Wire with bending and axial stiffness and mass only; all other properties are NaN. */
Discretisation bareWire(double rest_curvature = 0.0)
{
  Wire wire = uniformWire(0.2, 5e-5, 1.8e-4, 7900.0);
  wire.sections[0].rest_curvature.x() = rest_curvature;
  Discretisation rod = discretiseUniformly(wire, kNodes);
  for (std::vector<double>* unknown : {&rod.torsional_stiffness, &rod.radius, &rod.friction, &rod.axial_stiffness})
    unknown->assign(unknown->size(), std::nan(""));
  return rod;
}

Boundary bareClamp()
{
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  boundary.director.setConstant(std::nan(""));
  boundary.guide_decay = std::nan("");
  return boundary;
}

Environment vacuum()
{
  Environment environment;
  environment.drag_coefficient = std::nan("");
  return environment;
}

StepperSettings withoutContact()
{
  StepperSettings settings;
  settings.contact_stiffness = settings.contact_margin = settings.friction_slip = std::nan("");
  return settings;
}

struct Outcome
{
  bool finite = true;
  bool solved = true;
  PhaseTimer timer;
};

/** Twenty steps with a lateral force at the tip. */
Outcome run(Discretisation rod, const Boundary& boundary, const Environment& environment, StepInput input = {})
{
  KktStepper stepper(std::move(rod), boundary, environment, withoutContact());
  State state = stepper.initialState(0.0, 0.0);
  input.forces.push_back({kNodes - 1, Eigen::Vector3d(0.0, 1e-3, 0.0)});
  Outcome outcome;
  for (int k = 0; k < 20; ++k)
  {
    std::uint32_t pass = 0;
    outcome.solved = stepper.step(state, input, 1e-3, pass, nullptr, outcome.timer).solved && outcome.solved;
  }
  for (const Eigen::Vector3d& x : state.position)
    outcome.finite = outcome.finite && x.allFinite();
  EXPECT_EQ(outcome.timer.entries(Phase::kCollision), 0);
  EXPECT_EQ(outcome.timer.entries(Phase::kSampling), 0);
  EXPECT_EQ(outcome.timer.seconds(Phase::kCollision), 0.0);
  EXPECT_EQ(outcome.timer.seconds(Phase::kSampling), 0.0);
  return outcome;
}

TEST(OmittedTerms, AWireThatOnlyBendsComputesNothingElse)
{
  const Outcome outcome = run(bareWire(), bareClamp(), vacuum());
  EXPECT_TRUE(outcome.solved);
  EXPECT_TRUE(outcome.finite);
  EXPECT_EQ(outcome.timer.entries(Phase::kTwist), 0);
  EXPECT_EQ(outcome.timer.seconds(Phase::kTwist), 0.0);
  EXPECT_GE(outcome.timer.entries(Phase::kSolve), 20);
}

TEST(OmittedTerms, TurningAStraightIsotropicWireSolvesNoTwist)
{
  StepInput input;
  input.rotation = 1.0;
  EXPECT_EQ(run(bareWire(), bareClamp(), vacuum(), input).timer.entries(Phase::kTwist), 0);
}

TEST(OmittedTerms, TheTwistIsSolvedForRestCurvatureTorquesOrATwistHeldAtBothEnds)
{
  EXPECT_GT(run(bareWire(5.0), bareClamp(), vacuum()).timer.entries(Phase::kTwist), 0);
  StepInput torque;
  torque.tip_torque = 1e-6;
  EXPECT_GT(run(bareWire(), bareClamp(), vacuum(), torque).timer.entries(Phase::kTwist), 0);
  StepInput along;
  along.edge_torque.assign(kNodes - 1, 1e-6);
  EXPECT_GT(run(bareWire(), bareClamp(), vacuum(), along).timer.entries(Phase::kTwist), 0);
  Boundary both = bareClamp();
  both.distal = EndHold::kClamped;
  both.distal_twist_held = true;
  EXPECT_GT(run(bareWire(), both, vacuum()).timer.entries(Phase::kTwist), 0);
}

// The proof is valid: each term, once it is needed, uses a property of NaN.
TEST(OmittedTerms, UndefinedPropertiesSpreadAsSoonAsATermUsesThem)
{
  Environment fluid = vacuum();
  fluid.fluid_density = 1060.0;
  EXPECT_FALSE(run(bareWire(), bareClamp(), fluid).solved);
  Environment weight = vacuum();
  weight.gravity.z() = -9.81;
  EXPECT_FALSE(run(bareWire(), bareClamp(), weight).solved);  // buoyancy needs the radius
  EXPECT_FALSE(run(bareWire(5.0), bareClamp(), vacuum()).solved);
  Boundary introduced = bareClamp();
  introduced.introducer = true;
  EXPECT_FALSE(run(bareWire(), introduced, vacuum()).solved);
}

}  // namespace
}  // namespace endovascular_sim::rod
