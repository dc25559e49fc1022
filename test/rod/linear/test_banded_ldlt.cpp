#include "rod/linear/banded_ldlt.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace endovascular_sim::rod
{
namespace
{

constexpr int kBand = 10;

/** Random banded matrix; every third unknown from the fifth on has a negative diagonal, like a multiplier. */
template <int Period>
BandedLdlt<kBand, Period> randomMatrix(int size, std::mt19937& random, Eigen::MatrixXd& dense, int& negative)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  BandedLdlt<kBand, Period> matrix;
  matrix.reset(size);
  dense = Eigen::MatrixXd::Zero(size, size);
  negative = 0;
  for (int col = 0; col < size; ++col)
    for (int row = col; row <= std::min(size - 1, col + kBand - col % Period); ++row)
    {
      const bool multiplier = col >= 5 && col % 3 == 0;
      negative += row == col && multiplier;
      const double value = row == col ? (multiplier ? -25.0 : 25.0) : uniform(random);
      matrix.at(row, col) = value;
      dense(row, col) = dense(col, row) = value;
    }
  return matrix;
}

template <typename Type>
class BandedLdltOfPeriod : public testing::Test
{
};
using Periods =
    testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BandedLdltOfPeriod, Periods);

TYPED_TEST(BandedLdltOfPeriod, SolvesAnIndefiniteSystemLikeADensePivotedSolver)
{
  std::mt19937 random(1);
  for (int size : {1, 5, 11, 12, 13, 14, 15, 16, 60, 333})
  {
    Eigen::MatrixXd dense;
    int negative = 0;
    auto matrix = randomMatrix<TypeParam::value>(size, random, dense, negative);
    std::vector<double> rhs(size);
    for (double& value : rhs)
      value = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    const Eigen::VectorXd expected = dense.fullPivLu().solve(Eigen::Map<Eigen::VectorXd>(rhs.data(), size));
    EXPECT_EQ(matrix.factorise(), negative);
    matrix.solve(rhs);
    for (int i = 0; i < size; ++i)
      EXPECT_NEAR(rhs[i], expected[i], 1e-12);
  }
}

TYPED_TEST(BandedLdltOfPeriod, GoesOnWhereTheMatrixChangedToTheSameBits)
{
  std::mt19937 random(3);
  Eigen::MatrixXd dense;
  int negative = 0;
  const int size = 333;
  auto base = randomMatrix<TypeParam::value>(size, random, dense, negative);
  auto fast = base;
  fast.factorise();
  int copied_less = 0;
  int last_changed = 0;
  for (const int changed : {0, 5, 40, 64, 75, 76, 77, 200, 130, 290, 318, 332, 333})
  {
    const auto add = [&](auto& matrix, int from)
    {
      for (int col = std::max(from, changed); col < size; ++col)
        matrix.at(col, col) += 1.0 + 0.01 * changed;
    };
    // Terms of the last change lie behind this one, or are removed with it.
    auto slow = base;
    slow.copyFrom(base);
    add(slow, 0);
    const int expected = slow.factorise();
    const int copied = fast.rewind(base, std::min(changed, last_changed));
    last_changed = changed;
    copied_less += copied > 0;
    EXPECT_LE(copied, changed);
    add(fast, copied);
    EXPECT_EQ(fast.factorise(), expected);
    std::vector<double> rhs(size, 1.0);
    std::vector<double> same(size, 1.0);
    fast.solve(rhs);
    slow.solve(same);
    EXPECT_EQ(rhs, same) << changed;
  }
  EXPECT_GT(copied_less, 4) << "factors of earlier columns were reused";
}

TYPED_TEST(BandedLdltOfPeriod, CountsNegativePivotsAsTheInertiaSays)
{
  std::mt19937 random(2);
  Eigen::MatrixXd dense;
  int negative = 0;
  auto matrix = randomMatrix<TypeParam::value>(90, random, dense, negative);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense);
  EXPECT_EQ(matrix.factorise(), (eigen.eigenvalues().array() < 0.0).count());
}

TEST(BandedLdlt, ReportsAZeroPivotAndAPivotThatIsNotANumber)
{
  BandedLdlt<kBand> matrix;
  matrix.reset(3);
  EXPECT_EQ(matrix.factorise(), -1);
  matrix.reset(1);
  matrix.at(0, 0) = std::nan("");
  EXPECT_EQ(matrix.factorise(), -1);
}

TEST(BandedLdlt, PrescribesAnUnknownExactly)
{
  std::mt19937 random(3);
  Eigen::MatrixXd dense;
  int negative = 0;
  auto matrix = randomMatrix<4>(40, random, dense, negative);
  std::vector<double> rhs(40, 1.0);
  matrix.prescribe(17, 0.25, 2.0, rhs);
  matrix.factorise();
  matrix.solve(rhs);
  EXPECT_NEAR(rhs[17], 0.25, 1e-15);
  const Eigen::VectorXd x = Eigen::Map<Eigen::VectorXd>(rhs.data(), 40);
  const Eigen::VectorXd residual = dense * x - Eigen::VectorXd::Ones(40);
  for (int i = 0; i < 40; ++i)
    if (i != 17)
    {
      EXPECT_NEAR(residual[i], 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace endovascular_sim::rod
