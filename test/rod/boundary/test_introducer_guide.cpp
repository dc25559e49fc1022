#include "rod/boundary/introducer_guide.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "rod/boundary/introducer_sheath.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

Boundary obliqueBoundary()
{
  Boundary boundary;
  boundary.origin = Vector3d(0.01, -0.02, 0.03);
  boundary.direction = Vector3d(2.0, 1.0, -1.0).normalized();
  boundary.sheath_clearance = 0.2e-3;
  return boundary;
}

/** Point at an axial coordinate with a lateral offset [m]. */
Vector3d at(const Boundary& boundary, double axial, double u, double v)
{
  const Vector3d across = boundary.direction.unitOrthogonal();
  return boundary.origin + axial * boundary.direction + u * across + v * boundary.direction.cross(across);
}

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Vector6d gradientOf(const GuidedEdge& edge)
{
  Vector6d gradient;
  gradient << edge.gradient[0], edge.gradient[1];
  return gradient;
}

Matrix6d hessianOf(const GuidedEdge& edge)
{
  Matrix6d hessian;
  hessian << edge.first, edge.across.transpose(), edge.across, edge.second;
  return hessian;
}

/** Checks the gradient of a potential of two nodes by central differences.
 *  @return its second derivatives by central differences */
template <typename Evaluate>
Matrix6d expectGradient(const Vector3d& first, const Vector3d& second, Evaluate evaluate)
{
  const auto moved = [&](int k, double step)
  {
    Vector6d x;
    x << first, second;
    x[k] += step;
    GuidedEdge edge;
    evaluate(Vector3d(x.head<3>()), Vector3d(x.tail<3>()), edge);
    return edge;
  };
  const GuidedEdge edge = moved(0, 0.0);
  const double step = 1e-8;
  Matrix6d exact;
  Vector6d gradient;
  for (int k = 0; k < 6; ++k)
  {
    const GuidedEdge above = moved(k, step);
    const GuidedEdge below = moved(k, -step);
    gradient[k] = (above.energy - below.energy) / (2.0 * step);
    exact.col(k) = (gradientOf(above) - gradientOf(below)) / (2.0 * step);
  }
  EXPECT_LT((gradientOf(edge) - gradient).norm(), 1e-5 * gradient.norm());
  return exact;
}

TEST(IntroducerGuide, ForceAndStiffnessAreTheDerivativesOfItsEnergy)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerGuide guide(boundary);
  // Inside; across the mouth; across the guide's end; short part before its end.
  for (const auto& [from, to] :
       {std::pair(-7e-3, -4.5e-3), std::pair(-1e-3, 1.2e-3), std::pair(4e-3, 7e-3), std::pair(5.7e-3, 8.5e-3)})
  {
    SCOPED_TRACE(from);
    const Vector3d first = at(boundary, from, 0.3e-3, -0.1e-3);
    const Vector3d second = at(boundary, to, 0.9e-3, 0.4e-3);
    const auto evaluate = [&guide](const Vector3d& a, const Vector3d& b, GuidedEdge& edge)
    { guide.evaluate(a, b, 2.5e-7, edge); };
    const Matrix6d exact = expectGradient(first, second, evaluate);
    GuidedEdge edge;
    evaluate(first, second, edge);
    EXPECT_LT((hessianOf(edge) - exact).norm(), 1e-5 * exact.norm());
  }
}

TEST(IntroducerGuide, SemiDefiniteStiffnessDiffersFromTheExactOneAlongTheAxisOnly)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerGuide guide(boundary);
  GuidedEdge exact, semi;
  const Vector3d first = at(boundary, -7e-3, 0.3e-3, -0.1e-3);
  const Vector3d second = at(boundary, -4.5e-3, 0.9e-3, 0.4e-3);
  guide.evaluate(first, second, 2.5e-7, exact);
  guide.evaluate(first, second, 2.5e-7, semi, GuideStiffness::kSemiDefinite);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> exact_values(hessianOf(exact));
  const Eigen::SelfAdjointEigenSolver<Matrix6d> semi_values(hessianOf(semi));
  EXPECT_LT(exact_values.eigenvalues().minCoeff(), -1e-3 * exact_values.eigenvalues().maxCoeff());
  EXPECT_GT(semi_values.eigenvalues().minCoeff(), -1e-9 * semi_values.eigenvalues().maxCoeff());
  EXPECT_EQ(gradientOf(exact), gradientOf(semi));
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - boundary.direction * boundary.direction.transpose();
  EXPECT_LT((across * (semi.first - exact.first)).norm(), 1e-12 * exact.first.norm());
  EXPECT_LT((across * (semi.across - exact.across)).norm(), 1e-12 * exact.first.norm());
}

TEST(IntroducerGuide, EnergyOfAnEdgeIsTheIntegralOfItsDensity)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerGuide guide(boundary);
  const Vector3d first = at(boundary, 2e-3, 0.3e-3, -0.1e-3);
  const Vector3d second = at(boundary, 8e-3, 0.9e-3, 0.4e-3);
  const double weight = 2.5e-7;
  GuidedEdge edge;
  guide.evaluate(first, second, weight, edge);
  double sum = 0.0;
  const int parts = 20000;
  for (int k = 0; k < parts; ++k)
    sum += weight / parts * guide.density(first + (k + 0.5) / parts * (second - first));
  EXPECT_NEAR(edge.energy, sum, 1e-6 * sum);
}

TEST(IntroducerGuide, FadesAlongItsLengthAndEndsBehindTheMouth)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerGuide guide(boundary);
  double before = INFINITY;
  for (double axial = -0.015; axial < 5.79e-3; axial += 1e-4)
  {
    const double density = guide.density(at(boundary, axial, 1e-4, 0.0));
    EXPECT_LT(density, before);
    EXPECT_GT(density, 0.0);
    before = density;
  }
  EXPECT_FALSE(guide.holds(at(boundary, 5.8e-3, 1e-4, 0.0)));
  EXPECT_EQ(guide.density(at(boundary, 5.8e-3, 1e-4, 0.0)), 0.0);
}

// At most a quarter of the guide's length: the deflection has decayed where nodes are released.
TEST(IntroducerGuide, IsShorterInAShortIntroducer)
{
  Boundary boundary = obliqueBoundary();
  boundary.guide_length = 4e-3;
  EXPECT_FALSE(IntroducerGuide(boundary).holds(at(boundary, 2e-3, 0.0, 0.0)));
  EXPECT_TRUE(IntroducerGuide(boundary).holds(at(boundary, 1.9e-3, 0.0, 0.0)));
  boundary.guide_length = 0.0;
  EXPECT_FALSE(IntroducerGuide(boundary).holds(at(boundary, -1e-3, 0.0, 0.0)));
}

// No jump of energy or force while a node passes the guide's end.
TEST(IntroducerGuide, EnergyAndForceOfAWireAreSmoothWhileNodesPassItsEnd)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerGuide guide(boundary);
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, 1e-4, 2e-4, 8000.0), 41);
  State state = BoundaryConditions(rod, boundary).initialState(0.03, 0.0);
  const auto push = [&](double travel, double& energy)
  {
    for (int i = 0; i < rod.nodes(); ++i)
    {
      const double axial = rod.position[i] - 0.07 + travel;
      state.position[i] = at(boundary, axial, 5.0 * std::pow(std::max(0.0, axial + 0.01), 2), 0.0);
    }
    double force = 0.0;
    energy = 0.0;
    guide.forEachEdge(rod, state,
                      [&](int /*edge*/, const GuidedEdge& term)
                      {
                        energy += term.energy;
                        force -= boundary.direction.dot(term.gradient[0] + term.gradient[1]);
                      });
    return force;
  };
  const double step = 1e-5;
  double energy = 0.0;
  double last = push(0.0, energy);
  double last_energy = energy;
  for (double travel = step; travel < 5e-3; travel += step)
  {
    const double force = push(travel, energy);
    EXPECT_GT(force, 0.0);
    EXPECT_LT(std::abs(force - last), 5e-3 * force);
    EXPECT_LT(std::abs(energy - last_energy), 5e-3 * energy);
    last = force;
    last_energy = energy;
  }
}

// A cantilever from the mouth: the guide's reach compensates for its compliance, whatever the stiffness of the wire.
TEST(IntroducerGuide, HoldsTheWireLikeAClampAtTheMouth)
{
  constexpr double kFree = 0.06;
  for (const double stiffness : {1e-5, 1e-3})
    for (const double guide_length : {12e-3, 30e-3})
    {
      Boundary boundary;
      boundary.guide_length = guide_length;
      Environment environment;
      environment.damping = 400.0;
      KktStepper stepper(discretiseUniformly(uniformWire(0.2, stiffness, 2e-4, 8000.0), 101), boundary, environment,
                         StepperSettings());
      State state = stepper.initialState(kFree, 0.0);
      StepInput input;
      input.inserted_length = kFree;
      const double load = 0.01 * stiffness / (kFree * kFree);
      input.forces.push_back({100, Vector3d(0.0, load, 0.0)});
      ASSERT_GE(settle(stepper, state, input, 1e-2, 1e-11, 20000), 0);
      const double exact = load * kFree * kFree * kFree / (3.0 * stiffness);
      EXPECT_NEAR(state.position.back().y(), exact, 5e-3 * exact);
    }
}

void expectSemiDefinite(const GuidedEdge& edge)
{
  const Matrix6d hessian = hessianOf(edge);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(hessian).eigenvalues().minCoeff(), -1e-9 * hessian.norm());
}

TEST(IntroducerSheath, ForceIsTheDerivativeOfItsEnergyAndTheStiffnessSemiDefinite)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerSheath sheath(boundary);
  for (const double axial : {-6e-3, -1.1e-3})
  {
    const Vector3d position = at(boundary, axial, 0.3e-3, 0.1e-3);
    const auto evaluate = [&sheath](const Vector3d& a, const Vector3d& /*unused*/, GuidedEdge& edge)
    { EXPECT_TRUE(sheath.evaluateNode(a, 1e-3, edge)); };
    const Matrix6d exact = expectGradient(position, boundary.origin, evaluate);
    GuidedEdge edge;
    evaluate(position, boundary.origin, edge);
    expectSemiDefinite(edge);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - boundary.direction * boundary.direction.transpose();
    EXPECT_LT((across * (edge.first - exact.topLeftCorner<3, 3>())).norm(), 1e-5 * exact.norm());
  }
  const auto rim = [&sheath](const Vector3d& a, const Vector3d& b, GuidedEdge& edge)
  { EXPECT_TRUE(sheath.evaluateRim(a, b, edge)); };
  const Vector3d first = at(boundary, -1e-3, 0.15e-3, 0.1e-3);
  const Vector3d second = at(boundary, 0.6e-3, 0.35e-3, 0.1e-3);
  expectGradient(first, second, rim);
  GuidedEdge edge;
  rim(first, second, edge);
  expectSemiDefinite(edge);
  EXPECT_NEAR((edge.gradient[0] + edge.gradient[1]).dot(second - first), 0.0,
              1e-12 * (edge.gradient[0] + edge.gradient[1]).norm());  // the rim is smooth
}

TEST(IntroducerSheath, HasNoForceWithinItsClearanceAndBehindTheMouth)
{
  const Boundary boundary = obliqueBoundary();
  const IntroducerSheath sheath(boundary);
  GuidedEdge edge;
  EXPECT_FALSE(sheath.evaluateNode(at(boundary, -3e-3, 0.19e-3, 0.0), 1e-3, edge));
  EXPECT_FALSE(sheath.evaluateNode(at(boundary, 0.0, 0.5e-3, 0.0), 1e-3, edge));
  EXPECT_FALSE(sheath.evaluateRim(at(boundary, 0.0, 0.5e-3, 0.0), at(boundary, 1e-3, 0.5e-3, 0.0), edge));
  EXPECT_FALSE(sheath.evaluateRim(at(boundary, -1e-3, 0.1e-3, 0.0), at(boundary, 1e-3, 0.2e-3, 0.0), edge));
}

}  // namespace
}  // namespace endovascular_sim::rod
