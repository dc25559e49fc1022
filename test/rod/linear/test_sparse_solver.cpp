#include "rod/linear/sparse_solver.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr int kSize = 40;

/** Symmetric sparse matrix, positive definite when @p diagonal is large. */
SparseMatrix randomSymmetric(unsigned seed, double diagonal)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < kSize; ++i)
  {
    entries.emplace_back(i, i, diagonal + uniform(random));
    for (const int j : {i + 1, i + 7})
      if (j < kSize)
      {
        const double value = uniform(random);
        entries.emplace_back(i, j, value);
        entries.emplace_back(j, i, value);
      }
  }
  SparseMatrix matrix(kSize, kSize);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd someRhs()
{
  Eigen::VectorXd rhs(kSize);
  for (int i = 0; i < kSize; ++i)
    rhs[i] = std::sin(1.3 * i) + 0.2;
  return rhs;
}

template <typename Solver>
void expectAgreesWithDense(Solver& solver, const SparseMatrix& matrix)
{
  ASSERT_TRUE(solver.factorise(matrix));
  Eigen::VectorXd x = someRhs();
  solver.solve(x.data());
  const Eigen::VectorXd dense = Eigen::MatrixXd(matrix).fullPivLu().solve(someRhs());
  EXPECT_LT((x - dense).norm(), 1e-11 * dense.norm());
}

TEST(SparseSolver, KluSolvesIndefiniteMatricesAsTheDenseSolverDoes)
{
  KluSolver solver;
  expectAgreesWithDense(solver, randomSymmetric(1, 0.0));
  expectAgreesWithDense(solver, randomSymmetric(2, 0.0));
  expectAgreesWithDense(solver, SparseMatrix(randomSymmetric(3, 0.0) * randomSymmetric(4, 0.0)));
}

TEST(SparseSolver, CholmodSolvesPositiveDefiniteMatricesAsTheDenseSolverDoes)
{
  CholmodSolver solver;
  expectAgreesWithDense(solver, randomSymmetric(1, 5.0));
  expectAgreesWithDense(solver, randomSymmetric(2, 6.0));
  const SparseMatrix root = randomSymmetric(3, 0.0);
  expectAgreesWithDense(solver, SparseMatrix(root * root));
}

TEST(SparseSolver, RejectsSingularAndIndefiniteMatricesAndContinuesWithRegularOnes)
{
  KluSolver klu;
  SparseMatrix singular = randomSymmetric(1, 0.0);
  for (int k = singular.outerIndexPtr()[4]; k < singular.outerIndexPtr()[5]; ++k)
    singular.valuePtr()[k] = 0.0;
  EXPECT_FALSE(klu.factorise(singular));
  expectAgreesWithDense(klu, randomSymmetric(1, 0.0));
  CholmodSolver cholmod;
  EXPECT_FALSE(cholmod.factorise(randomSymmetric(1, 0.0)));
  expectAgreesWithDense(cholmod, randomSymmetric(1, 5.0));
}

TEST(SparseSolver, BandIsCopiedEntryByEntry)
{
  BandedLdlt<2> band;
  band.reset(4);
  for (int col = 0; col < 4; ++col)
    for (int row = col; row < std::min(4, col + 3); ++row)
      band.at(row, col) = 10.0 * row + col + 1.0;
  const Eigen::MatrixXd dense(sparseFromBand(band));
  for (int col = 0; col < 4; ++col)
    for (int row = col; row < 4; ++row)
    {
      EXPECT_EQ(dense(row, col), row > col + 2 ? 0.0 : 10.0 * row + col + 1.0);
      EXPECT_EQ(dense(col, row), dense(row, col));
    }
}

/** Positions after every step of a pre-curved wire that is pushed in and turned. */
std::vector<Eigen::Vector3d> drivenTrajectory(LinearSolver linear_solver)
{
  Wire wire = uniformWire(0.15, 4.9469e-5, 1.8e-4, 7900.0);
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.02;
  wire.sections[1].rest_curvature = Eigen::Vector2d(60.0, 10.0);
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  StepperSettings settings;
  settings.linear_solver = linear_solver;
  KktStepper stepper(discretiseUniformly(wire, 86), Boundary(), environment, settings);
  State state = stepper.initialState(0.04, 0.0);
  PhaseTimer timer;
  StepInput input;
  input.inserted_length = 0.04;
  std::vector<Eigen::Vector3d> all;
  for (int k = 0; k < 1000; ++k)
  {
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    input.inserted_length += 5e-5;
    input.rotation += 5e-3;
    EXPECT_TRUE(stepper.step(state, input, 1e-3, pass, nullptr, timer).solved);
    all.insert(all.end(), state.position.begin() + state.first_node, state.position.end());
  }
  return all;
}

TEST(SparseSolver, ADrivenPreCurvedWireMovesAlikeWithTheBandedAndTheSparseSolver)
{
  const std::vector<Eigen::Vector3d> banded = drivenTrajectory(LinearSolver::kBanded);
  const std::vector<Eigen::Vector3d> sparse = drivenTrajectory(LinearSolver::kSparse);
  ASSERT_EQ(banded.size(), sparse.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < banded.size(); ++i)
    worst = std::max(worst, (banded[i] - sparse[i]).norm());
  EXPECT_LT(worst, 1e-9 * 0.17);
  EXPECT_GT(worst, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::rod
