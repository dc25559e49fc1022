#include "rod/contact/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "rod/kkt/kkt_stepper.h"
#include "rod/mixed/mixed_stepper.h"
#include "test/rod/plane_wall.h"
#include "test/rod/ridge_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEi = 4.9469e-5;
constexpr double kRadius = 1.8e-4;
constexpr double kFriction = 0.2;

struct Bench
{
  PlaneWall floor{kFriction};
  MixedStepper stepper;
  State state;
  PhaseTimer timer;

  static Boundary freeBoundary(double height)
  {
    Boundary boundary;
    boundary.introducer = false;
    boundary.origin = Vector3d(0.0, 0.0, height);
    return boundary;
  }

  static Environment gravity()
  {
    Environment environment;
    environment.gravity = Vector3d(0.0, 0.0, -9.81);
    return environment;
  }

  explicit Bench(double height)
    : stepper(uniformWire(0.1, kEi, kRadius, 7900.0), discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), 21),
              freeBoundary(height), gravity(), StepperSettings()),
      state(stepper.initialState(0.0, 0.0))
  {
  }

  void run(double dt, int steps)
  {
    for (int k = 0; k < steps; ++k)
    {
      std::uint32_t pass = 0;
      StepInput input;
      input.step = static_cast<std::uint64_t>(k);
      ASSERT_TRUE(stepper.step(state, input, dt, pass, &floor, timer).solved);
    }
  }

  double weight() const
  {
    double sum = 0.0;
    for (const double mass : stepper.discretisation().mass)
      sum += 9.81 * mass;
    return sum;
  }
};

TEST(ContactSolver, AFallenWireLiesOnTheFloorWhichCarriesItsWeight)
{
  Bench bench(2e-3);
  bench.run(1e-3, 400);
  Vector3d force = Vector3d::Zero();
  for (std::size_t i = 0; i < bench.state.position.size(); ++i)
  {
    force += bench.state.wall_force[i];
    EXPECT_GT(bench.state.position[i].z(), kRadius - 1e-6);
    EXPECT_LT(bench.state.position[i].z(), kRadius + 1e-6);
  }
  EXPECT_NEAR(force.z(), bench.weight(), 1e-6 * bench.weight());
}

TEST(ContactSolver, AFastWireDoesNotTunnel)
{
  Bench bench(20e-3);
  for (Vector3d& velocity : bench.state.velocity)
    velocity = Vector3d(0.0, 0.0, -20.0);  // 20 mm per step
  bench.run(1e-3, 50);
  for (const Vector3d& position : bench.state.position)
    EXPECT_GT(position.z(), kRadius - 1e-5);
}

TEST(ContactSolver, ASlidingWireIsBrakedByCoulombFriction)
{
  Bench bench(kRadius);
  bench.run(1e-3, 50);
  for (Vector3d& velocity : bench.state.velocity)
    velocity = Vector3d(0.2, 0.1, 0.0);
  const double before = bench.state.velocity[10].norm();
  bench.run(1e-3, 40);
  EXPECT_NEAR(bench.state.velocity[10].norm(), before - kFriction * 9.81 * 0.04, 1e-3);
  bench.run(1e-3, 200);
  EXPECT_LT(bench.state.velocity[10].norm(), 1e-4);
}

/** Depth at the ridge of a stiff wire that is pressed on a compliant roof all along [m]. */
double indentation(int nodes, double ridge, double load)
{
  constexpr double kLength = 0.1;
  constexpr double kStiffness = 1e4;  // N/m²
  Boundary boundary;
  boundary.introducer = false;
  boundary.origin = Vector3d(0.0, 0.0, kRadius);
  Environment environment;
  environment.damping = 100.0;
  KktStepper stepper(discretiseUniformly(uniformWire(kLength, 1.0, kRadius, 7900.0), nodes), boundary, environment,
                     StepperSettings());
  RidgeWall wall(ridge, 1e-3, kStiffness);
  State state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  StepInput input;
  for (int i = 0; i < nodes; ++i)
    input.forces.push_back({i, Vector3d(0.0, 0.0, -load * stepper.discretisation().cell_length[i] / kLength)});
  for (int k = 0; k < 500; ++k)
  {
    input.step = static_cast<std::uint64_t>(k);
    std::uint32_t pass = 0;
    EXPECT_TRUE(stepper.step(state, input, 1e-3, pass, &wall, timer).solved);
  }
  double depth = 0.0;
  for (int i = 0; i + 1 < nodes; ++i)
  {
    const double t = (ridge - state.position[i].x()) / (state.position[i + 1].x() - state.position[i].x());
    if (t >= 0.0 && t <= 1.0)
      depth = kRadius - ((1.0 - t) * state.position[i].z() + t * state.position[i + 1].z());
  }
  return depth;
}

TEST(ContactSolver, ACompliantWallGivesWayByTheSameForAnySamplingWhereTheWireCrossesARidge)
{
  // A rigid wire in touch all along: F = k ∫(depth − slope·|x|) dx about a ridge in its middle.
  constexpr double kLoad = 0.05;  // less than the travel after which a soft wall is rigid
  const double expected = kLoad / (1e4 * 0.1) + 1e-3 * 0.1 / 4.0;
  for (const int nodes : {20, 40, 80})
    EXPECT_NEAR(indentation(nodes, 0.05, kLoad), expected, 2e-3 * expected) << nodes;
  // Wherever the ridge meets an edge: at its middle, near its end, and on a node.
  const double off_centre = indentation(80, 0.0531, kLoad);
  for (const int nodes : {20, 21, 40, 41})
    EXPECT_NEAR(indentation(nodes, 0.0531, kLoad), off_centre, 1e-2 * off_centre) << nodes;
}

TEST(ContactSolver, ForceOfACompliantWallIsContinuousWhereARidgePassesANode)
{
  const double place = 0.1 * 20 / 40;  // of a node
  const double before = indentation(41, place - 1e-7, 0.1);
  EXPECT_NEAR(indentation(41, place, 0.1), before, 1e-4 * before);
  EXPECT_NEAR(indentation(41, place + 1e-7, 0.1), before, 1e-4 * before);
}

/** Two planes that one node touches. */
class Groove : public contact::ContactSource
{
public:
  double angle = 0.0;           ///< between their normals [rad]
  double gaps[2] = {0.0, 0.0};  ///< [m]

  void detect(const contact::Query&, contact::ContactSet& set) override
  {
    set.features.clear();
    set.stale = false;
    for (int k = 0; k < 2; ++k)
    {
      contact::Feature feature;
      feature.edge = 10;
      feature.normal = Vector3d(0.0, (k == 0 ? 1.0 : -1.0) * std::sin(0.5 * angle), std::cos(0.5 * angle));
      feature.gap = gaps[k];
      feature.stiffness = 1e4;
      feature.id = 3 * k;
      set.features.push_back(feature);
    }
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }
};

/** The springs of a node in a groove, as its stiffness over the wall's. */
Eigen::Matrix3d stiffnessInGroove(Groove& groove)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), 21);
  const Boundary boundary = Bench::freeBoundary(0.0);
  const StepperSettings settings;
  ContactSolver contacts(rod, boundary, settings);
  const State state = Bench(0.0).state;
  PhaseTimer timer;
  StepReport report;
  std::uint32_t asked = 0;
  contacts.beginStep(StepInput(), &groove, asked, timer);
  contacts.refresh(state, report);
  contacts.prepare(state, 1e-3);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t c = 0; c < contacts.count(); ++c)
    if (contacts.spring(c).gap < 0.0)
      sum += contacts.spring(c).stiffness * contacts.feature(c).normal * contacts.feature(c).normal.transpose();
  return sum / (1e4 * 0.1 / 20);
}

TEST(ContactSolver, FacetsThatANodeTouchesAtOnceGiveWayLikeOneWall)
{
  Groove groove;
  groove.gaps[0] = groove.gaps[1] = -2e-5;
  for (const double angle : {0.0, 0.02, 0.3, 0.5 * M_PI})
  {
    groove.angle = angle;
    const Eigen::Vector3d values = stiffnessInGroove(groove).selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_NEAR(values.maxCoeff(), 1.0, 1e-9) << angle;
  }
}

TEST(ContactSolver, ASecondFacetTakesItsShareGraduallyAsItIsPressedIn)
{
  Groove groove;
  groove.angle = 0.05;
  groove.gaps[0] = -2e-5;
  groove.gaps[1] = 1e-9;
  const Eigen::Matrix3d before = stiffnessInGroove(groove);
  groove.gaps[1] = -1e-9;
  const Eigen::Matrix3d after = stiffnessInGroove(groove);
  EXPECT_NEAR(before(2, 2), std::pow(std::cos(0.025), 2), 1e-9);
  // What the second one adds at once acts over next to no depth.
  const Eigen::Vector3d first(0.0, std::sin(0.025), std::cos(0.025));
  const Eigen::Vector3d across(0.0, -std::sin(0.025), std::cos(0.025));
  const double own = after(2, 2) / (first.z() * first.z()) - 0.5;
  EXPECT_NEAR(own, 1.0, 1e-3);
  EXPECT_LT((after - before - 0.5 * across * across.transpose()).norm(), 1e-2);
}

/** A wall of one plane per node but the last, each with a direction and distance of its own. */
class RandomWall : public contact::ContactSource
{
public:
  std::vector<Vector3d> normals;
  std::vector<double> gaps;

  void detect(const contact::Query&, contact::ContactSet& set) override
  {
    set.features.clear();
    for (int i = 0; i < static_cast<int>(normals.size()); ++i)
    {
      contact::Feature feature;
      feature.edge = i;
      feature.normal = normals[i];
      feature.gap = gaps[i];
      feature.id = 3 * i;
      set.features.push_back(feature);
    }
    set.stale = false;
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }
};

/** Passes that the active set takes on a stiff random quadratic problem, until it is that of the solution. */
int passesOnRandomProblem(unsigned seed)
{
  constexpr int kNodes = 21;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, kEi, kRadius, 7900.0), kNodes);
  const Boundary boundary = Bench::freeBoundary(0.0);
  const StepperSettings settings;
  const State state = Bench(0.0).state;
  RandomWall wall;
  const int size = 3 * kNodes;
  Eigen::MatrixXd root(size, size);
  Eigen::VectorXd load(size);
  for (int k = 0; k < size; ++k)
  {
    load[k] = 0.05 * uniform(random);
    for (int j = 0; j < size; ++j)
      root(k, j) = uniform(random);
  }
  for (int i = 0; i + 1 < kNodes; ++i)
  {
    wall.normals.push_back(Vector3d(uniform(random), uniform(random), uniform(random)).normalized());
    wall.gaps.push_back(1e-6 * uniform(random));
  }
  const Eigen::MatrixXd rest = 1e3 * root * root.transpose() + 10.0 * Eigen::MatrixXd::Identity(size, size);

  ContactSolver contacts(rod, boundary, settings);
  PhaseTimer timer;
  StepReport report;
  std::uint32_t asked = 0;
  contacts.beginStep(StepInput(), &wall, asked, timer);
  contacts.refresh(state, report);
  contacts.prepare(state, 1e-3);
  ContactSolver::Motion motion(kNodes);
  for (int pass = 0; pass < 12; ++pass)
  {
    Eigen::MatrixXd matrix = rest;
    Eigen::VectorXd right = load;
    for (std::size_t c = 0; c < contacts.count(); ++c)
    {
      const ContactSolver::Spring& spring = contacts.spring(c);
      if (!spring.active)
        continue;
      const Vector3d& normal = contacts.feature(c).normal;
      matrix.block<3, 3>(3 * spring.node, 3 * spring.node) += spring.stiffness * normal * normal.transpose();
      right.segment<3>(3 * spring.node) -= spring.stiffness * spring.gap * normal;
    }
    const Eigen::VectorXd solution = matrix.llt().solve(right);
    for (int i = 0; i < kNodes; ++i)
      motion[i] = solution.segment<3>(3 * i);
    if (!contacts.updateActiveSet(motion, pass, pass > 0))
      return pass + 1;
  }
  return 13;
}

TEST(ContactSolver, TheActiveSetOfAConvexProblemIsFoundBeforeContactsAreOnlyAdded)
{
  int most = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    const int passes = passesOnRandomProblem(seed);
    EXPECT_LE(passes, 12) << seed;
    most = std::max(most, passes);
  }
  EXPECT_GT(most, 2);  // else the problems are too easy to tell
}

}  // namespace
}  // namespace endovascular_sim::rod
