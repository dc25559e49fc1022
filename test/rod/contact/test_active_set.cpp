#include "rod/contact/active_set.h"

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

ContactSpring springAt(int node, double gap, double stiffness)
{
  ContactSpring spring;
  spring.node = node;
  spring.weight0 = 1.0;
  spring.stiffness = stiffness;
  spring.gap = gap;
  spring.active = gap < 0.0;
  return spring;
}

void add(ContactList& contacts, const ContactSpring& spring, const Vector3d& normal)
{
  contact::Feature feature;
  feature.edge = spring.node;
  feature.normal = normal;
  contacts.set.features.push_back(feature);
  contacts.springs.push_back(spring);
}

class TwoSprings : public testing::Test
{
protected:
  TwoSprings()
  {
    add(contacts_, springAt(3, 2e-6, 1e5), Vector3d::UnitZ());
    add(contacts_, springAt(5, -1e-6, 1e5), Vector3d::UnitZ());
  }

  NodalMotion motion_ = NodalMotion(8, Vector3d::Zero());
  ContactList contacts_;
  ActiveSet active_set_;
};

TEST_F(TwoSprings, RemainUnchangedIfConsistentWithTheSolution)
{
  motion_[3].z() = -1e-6;
  motion_[5].z() = 0.5e-6;
  EXPECT_FALSE(active_set_.update(contacts_, motion_, 0, false));
}

TEST_F(TwoSprings, AreActiveWhereTheFirstSolutionCompressesThem)
{
  motion_[3].z() = -3e-6;
  motion_[5].z() = 2e-6;
  EXPECT_TRUE(active_set_.update(contacts_, motion_, 0, false));
  EXPECT_TRUE(contacts_.springs[0].active);
  EXPECT_FALSE(contacts_.springs[1].active);
  EXPECT_EQ(active_set_.firstChanged(), 3);
}

TEST_F(TwoSprings, AreNotDeactivatedFromTheTwelfthPassOn)
{
  motion_[5].z() = 2e-6;
  EXPECT_FALSE(active_set_.update(contacts_, motion_, 12, true));
  motion_[3].z() = -3e-6;
  EXPECT_TRUE(active_set_.update(contacts_, motion_, 12, true));
  EXPECT_TRUE(contacts_.springs[0].active);
  EXPECT_TRUE(contacts_.springs[1].active);
}

/** Number of passes until the active set of a random, ill-conditioned quadratic problem converges. */
int passesOnRandomProblem(unsigned seed)
{
  constexpr int kNodes = 21;
  constexpr int kSize = 3 * kNodes;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd root(kSize, kSize);
  Eigen::VectorXd load(kSize);
  for (int k = 0; k < kSize; ++k)
  {
    load[k] = 0.05 * uniform(random);
    for (int j = 0; j < kSize; ++j)
      root(k, j) = uniform(random);
  }
  ContactList contacts;
  for (int i = 0; i + 1 < kNodes; ++i)
  {
    const Vector3d normal = Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    add(contacts, springAt(i, 1e-6 * uniform(random), 1e5), normal);
  }
  const Eigen::MatrixXd without_springs =
      1e3 * root * root.transpose() + 10.0 * Eigen::MatrixXd::Identity(kSize, kSize);
  ActiveSet active_set;
  NodalMotion motion(kNodes);
  for (int pass = 0; pass < 12; ++pass)
  {
    Eigen::MatrixXd matrix = without_springs;
    Eigen::VectorXd rhs = load;
    for (std::size_t c = 0; c < contacts.springs.size(); ++c)
    {
      const ContactSpring& spring = contacts.springs[c];
      if (!spring.active)
        continue;
      const Vector3d& normal = contacts.set.features[c].normal;
      matrix.block<3, 3>(3 * spring.node, 3 * spring.node) += spring.stiffness * normal * normal.transpose();
      rhs.segment<3>(3 * spring.node) -= spring.stiffness * spring.gap * normal;
    }
    const Eigen::VectorXd solution = matrix.llt().solve(rhs);
    for (int i = 0; i < kNodes; ++i)
      motion[i] = solution.segment<3>(3 * i);
    if (!active_set.update(contacts, motion, pass, pass > 0))
      return pass + 1;
  }
  return 13;
}

TEST(ActiveSet, ConvergesOnConvexProblemsWithinTwelvePasses)
{
  int most = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    const int passes = passesOnRandomProblem(seed);
    EXPECT_LE(passes, 12) << seed;
    most = std::max(most, passes);
  }
  EXPECT_GT(most, 2);  // otherwise the problems are too easy
}

}  // namespace
}  // namespace endovascular_sim::rod
