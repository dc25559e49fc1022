#include <cmath>

#include <gtest/gtest.h>

#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/stack_fixtures.h"

// Layers that slide in each other: forces on their handles, and continuity.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLength = 0.3;
constexpr double kStep = 1e-3;  // [s]

/** Wire (by default with a J tip) in a catheter with a bent tip, both free beyond the introducer. */
struct WireAndCatheter
{
  explicit WireAndCatheter(const std::vector<LayerInput>& begin, const Wire& wire = jWire(),
                           const Wire& catheter = bentCatheter(), const Environment& environment = calm())
    : input(begin)
  {
    stepper = std::make_unique<KktStepper>(std::vector<Layer>{{wire}, {catheter}}, equalNodes(kLength, 151), Boundary(),
                                           environment, StepperSettings());
    state = stepper->initialState(begin);
    rest(300);
  }

  static Wire jWire() { return curvedTipWire(kLength, 0.02, 2e-5, 0.4e-3, 70.0); }
  static Wire bentCatheter() { return curvedTipWire(kLength, 0.03, 8e-5, 0.9e-3, 30.0); }

  /** One step towards the inputs. */
  void step(double dt = kStep)
  {
    std::uint32_t pass = 0;
    StepInput all;
    all.step = steps++;
    all.layers = input;
    EXPECT_TRUE(stepper->step(state, all, dt, pass, nullptr, timer).solved);
  }

  void rest(int count)
  {
    for (int k = 0; k < count; ++k)
    {
      for (Eigen::Vector3d& velocity : state.velocity)
        velocity *= 0.5;
      step(5e-3);
    }
  }

  double energy()
  {
    const Energy sum = stepper->energy(state);
    return sum.bending + sum.twist;
  }

  std::vector<LayerInput> input;
  std::unique_ptr<KktStepper> stepper;
  State state;
  PhaseTimer timer;
  std::uint64_t steps = 0;
};

/** Energy per length of two free layers in one plane, BB'/(B + B') (κ̄ − κ̄')²/2. */
double mismatch(double stiffness, double other_stiffness, double curvature, double other_curvature)
{
  const double difference = curvature - other_curvature;
  return 0.5 * stiffness * other_stiffness / (stiffness + other_stiffness) * difference * difference;
}

TEST(StackSliding, InsertionForceOfFreeLayersIsTheEnergyPerLengthAtTheirEnds)
{
  const Wire wire = curvedTipWire(kLength, 0.04, 2e-5, 0.4e-3, 10.0);
  for (const double catheter : {0.1150, 0.1157, 0.1170, 0.1189})
  {
    WireAndCatheter setup({{0.14, 0.0}, {catheter, 0.0}}, wire);
    StepInput at;
    at.layers = setup.input;
    // The bent part of the catheter advances over the wire's bent tip and leaves its straight shaft.
    const double expected = mismatch(4e-5, 1e-5, 30.0, 10.0) - mismatch(4e-5, 2e-5, 30.0, 0.0);
    EXPECT_NEAR(KktStepperPeer::insertionGradient(*setup.stepper, setup.state, at)[1], expected,
                0.01 * std::abs(expected));
  }
}

/** Potential energy of weight less buoyancy [J]. */
double weightEnergy(const Discretisation& rod, const Environment& environment, const State& state)
{
  double sum = 0.0;
  for (int i = state.first_node; i < rod.nodes(); ++i)
    sum -= (rod.mass[i] - environment.fluid_density * M_PI * rod.radius[i] * rod.radius[i] * rod.cell_length[i]) *
           environment.gravity.dot(state.position[i]);
  return sum;
}

/** Straight layers that do not bend: only the energy of weight depends on the insertion. */
TEST(StackSliding, TheWeightsGradientByTheInsertionAgreesWithFiniteDifferences)
{
  const Wire wire = uniformWire(kLength, 2e-5, 0.4e-3, 6000.0);
  const Wire catheter = uniformWire(kLength, 8e-5, 0.9e-3, 6000.0);
  Environment environment = calm();
  environment.gravity = Eigen::Vector3d(-3.0, 0.0, 9.0);
  KktStepper stepper({{wire}, {catheter}}, equalNodes(kLength, 151), Boundary(), environment, StepperSettings());
  for (const double inserted : {0.0801, 0.0893, 0.1184})
  {
    const State state = stepper.initialState({{0.12, 0.0}, {inserted, 0.0}});
    StepInput at;
    const auto potential = [&](double insertion)
    {
      State moved = state;
      moved.layers[1].inserted_length = insertion;
      KktStepperPeer::insertionGradient(stepper, moved, at);  // places the layers
      return weightEnergy(stepper.discretisation(), environment, moved);
    };
    const double gradient = KktStepperPeer::insertionGradient(stepper, state, at)[1];
    const double step = 1e-7;
    EXPECT_GT(gradient, 1e-3);
    EXPECT_NEAR((potential(inserted + step) - potential(inserted - step)) / (2.0 * step), gradient, 1e-5 * gradient);
  }
}

/** Straight layers that bend under their weight: the work of the handles is the gain of elastic energy and weight. */
TEST(StackSliding, WorkOfEveryHandleEqualsTheGainOfEnergy)
{
  const Wire wire = uniformWire(kLength, 2e-5, 0.4e-3, 6000.0);
  const Wire catheter = uniformWire(kLength, 8e-5, 0.9e-3, 6000.0);
  Environment environment = calm();
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  {
    const int moving = 1;
    WireAndCatheter setup({{0.12, 0.0}, {0.06, 0.0}}, wire, catheter, environment);
    const auto energy = [&]
    {
      const Discretisation& rod = setup.stepper->discretisation();
      return setup.energy() + weightEnergy(rod, environment, setup.state) + guideEnergy(rod, Boundary(), setup.state);
    };
    const double begin = energy();
    double work = 0.0;
    double force = setup.state.layers[moving].hand_force;
    const double travel = 2.5e-5;
    for (int k = 0; k < 1200; ++k)
    {
      setup.input[moving].inserted_length += travel;
      setup.step(0.2);
      work += 0.5 * travel * (force + setup.state.layers[moving].hand_force);
      force = setup.state.layers[moving].hand_force;
      EXPECT_NEAR(setup.state.layers[0].hand_force + setup.state.layers[1].hand_force, setup.state.hand_force, 1e-12);
    }
    const double gain = energy() - begin;
    EXPECT_GT(std::abs(gain), 2e-5);
    EXPECT_NEAR(work, gain, 0.02 * std::abs(gain)) << "layer " << moving;
  }
}

/** Path of a handle that accelerates smoothly for 0.3 s, in steps of full speed. */
double softStart(int step)
{
  constexpr double kSteps = 300.0;
  const double share = step / kSteps;
  return share < 1.0 ? kSteps * share * share * share * (1.0 - 0.5 * share) : step - 0.5 * kSteps;
}

/** Largest force of a run, and its largest change in one step. */
struct Smoothness
{
  double peak = 0.0;
  double jump = 0.0;
  double last = NAN;

  void add(double force)
  {
    peak = std::max(peak, std::abs(force));
    if (!std::isnan(last))
      jump = std::max(jump, std::abs(force - last));
    last = force;
  }
};

TEST(StackSliding, ForcesAreContinuousWhileATipSlidesPastNodes)
{
  WireAndCatheter setup({{0.12, 0.0}, {0.08, 0.0}});
  std::vector<Smoothness> layers(2);
  Smoothness whole;
  double motion = 0.0;
  for (int k = 0; k < 1500; ++k)
  {
    setup.input[1].inserted_length = 0.08 + 2.5e-5 * softStart(k);
    const Eigen::Vector3d before = setup.state.position.back();
    setup.step();
    motion = std::max(motion, (setup.state.position.back() - before).norm());
    for (int layer = 0; layer < 2; ++layer)
      layers[layer].add(setup.state.layers[layer].hand_force);
    whole.add(setup.state.hand_force);
  }
  for (int layer = 0; layer < 2; ++layer)
  {
    EXPECT_GT(layers[layer].peak, 3e-4);
    EXPECT_LT(layers[layer].jump, 0.02 * layers[layer].peak) << "layer " << layer;
  }
  EXPECT_LT(whole.jump, 0.02 * std::max(layers[0].peak, layers[1].peak));
  EXPECT_LT(motion, 0.5e-3);
}

/** Angle between the centreline's directions at the introducer and at the catheter's tip. */
double bend(const State& state, int node)
{
  const Eigen::Vector3d direction = (state.position[node + 1] - state.position[node]).normalized();
  return std::acos(direction.x());
}

TEST(StackSliding, ACatheterOverAStiffWireStraightensAndRecoversItsShapeAsTheWireLeaves)
{
  const Wire stiff = uniformWire(kLength, 4e-3, 0.4e-3, 6000.0);
  const int tip = 149;
  WireAndCatheter alone({{0.02, 0.0}, {0.1, 0.0}}, stiff);
  const double free_bend = bend(alone.state, tip);
  EXPECT_NEAR(free_bend, 0.9, 0.05);
  WireAndCatheter setup({{0.14, 0.0}, {0.1, 0.0}}, stiff);
  EXPECT_EQ(setup.state.reference, 0);
  EXPECT_LT(bend(setup.state, 150 - 20), 0.1 * free_bend);
  Smoothness total;
  std::vector<Smoothness> layers(2);
  for (int k = 0; k < 4950; ++k)
  {
    setup.input[0].inserted_length = 0.14 - 2.5e-5 * softStart(k);
    setup.step();
    total.add(setup.state.hand_force);
    for (int layer = 0; layer < 2; ++layer)
      layers[layer].add(setup.state.layers[layer].hand_force);
  }
  setup.rest(300);
  EXPECT_EQ(setup.state.reference, 1);
  EXPECT_NEAR(bend(setup.state, tip), free_bend, 1e-3);
  for (std::size_t i = static_cast<std::size_t>(setup.state.first_node); i < setup.state.position.size(); ++i)
    EXPECT_LT((setup.state.position[i] - alone.state.position[i]).norm(), 1e-4);
  EXPECT_LT(total.jump, 0.02 * std::max(layers[0].peak, layers[1].peak));
  EXPECT_LT(layers[0].jump, 0.02 * layers[0].peak);
  EXPECT_LT(layers[1].jump, 0.02 * layers[1].peak);
}

TEST(StackSliding, ForcesAndShapeAreContinuousAtAChangeOfTheReference)
{
  WireAndCatheter setup({{0.085, 0.0}, {0.08, 0.4}});
  std::vector<Smoothness> force(2), torque(2);
  double farthest = 0.0;
  double largest_acceleration = 0.0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int k = 0; k < 400; ++k)
  {
    const std::vector<Eigen::Vector3d> before = setup.state.position;
    const bool wire_leads = setup.state.reference == 0;
    setup.input[0].inserted_length = 0.085 - 2.53e-5 * softStart(k);
    setup.step();
    // Change of the shape: lateral displacement of the tip.
    const Eigen::Vector3d moved = setup.state.position[130] - before[130];
    const double relative = wire_leads && setup.state.reference == 0 ? -2.53e-5 : 0.0;
    farthest = std::max(farthest, moved.norm());
    const Eigen::Vector3d now = moved - relative * (before[131] - before[130]).normalized();
    if (k > 0 && wire_leads == (setup.state.reference == 0))
      largest_acceleration = std::max(largest_acceleration, (now - velocity).norm());
    if (wire_leads == (setup.state.reference == 0))
      velocity = now;
    for (int layer = 0; layer < 2; ++layer)
    {
      force[layer].add(setup.state.layers[layer].hand_force);
      torque[layer].add(setup.state.layers[layer].hand_torque);
    }
  }
  EXPECT_EQ(setup.state.reference, 1);
  EXPECT_LT(farthest, 1e-4);
  EXPECT_LT(largest_acceleration, 5e-6);
  for (int layer = 0; layer < 2; ++layer)
  {
    EXPECT_LT(force[layer].jump, 0.02 * force[layer].peak) << "layer " << layer;
    EXPECT_LT(torque[layer].jump, 0.02 * torque[layer].peak + 1e-9) << "layer " << layer;
  }
}

TEST(StackSliding, AStateContinuesInAnotherStepperBitForBitAlsoPastAChangeOfTheReference)
{
  WireAndCatheter one({{0.085, 0.0}, {0.08, 0.4}});
  WireAndCatheter other({{0.06, 0.0}, {0.09, 0.0}});
  for (int k = 0; k < 500; ++k)
  {
    if (k == 200)
      other.state = one.state;
    one.input[0] = {0.085 - 2.5e-5 * softStart(k), 1e-3 * k};
    other.input = one.input;
    other.steps = one.steps;
    one.step();
    if (k >= 200)
      other.step();
  }
  EXPECT_EQ(one.state.reference, 1);
  EXPECT_EQ(one.state.hash(), other.state.hash());
  for (int layer = 0; layer < 2; ++layer)
  {
    EXPECT_EQ(one.state.layers[layer].hand_force, other.state.layers[layer].hand_force);
    EXPECT_EQ(one.state.layers[layer].hand_torque, other.state.layers[layer].hand_torque);
  }
}

TEST(StackSliding, ARejectedStepLeavesTheRadiiOfTheStateBeforeIt)
{
  WireAndCatheter stack({{0.15, 0.0}, {0.1, 0.0}});
  const std::vector<double> radius = stack.stepper->discretisation().radius;
  StepInput impossible;
  impossible.layers = {{0.15, 0.0}, {0.105, 0.0}};
  impossible.forces.push_back({150, Eigen::Vector3d(std::nan(""), 0.0, 0.0)});
  std::uint32_t pass = 0;
  EXPECT_FALSE(stack.stepper->step(stack.state, impossible, kStep, pass, nullptr, stack.timer).solved);
  EXPECT_EQ(stack.stepper->discretisation().radius, radius);
}

}  // namespace
}  // namespace endovascular_sim::rod
