#include <random>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "geometry/mesh_distance.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

/** A straight duct with a star-shaped cross-section of random radii: it has sharp reflex edges.
 *  @param layer height of its quads [m]
 *  @param open whether the flat ends are omitted */
geometry::TriangleMesh starDuct(unsigned seed, double layer, bool open)
{
  constexpr int kCorners = 10;
  constexpr double kHeight = 0.02;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> radius(1.5e-3, 6e-3);
  const int layers = static_cast<int>(kHeight / layer);
  std::vector<double> radii;
  for (int k = 0; k < kCorners; ++k)
    radii.push_back(radius(random));
  geometry::TriangleMesh mesh;
  for (int z = 0; z <= layers; ++z)
    for (int k = 0; k < kCorners; ++k)
    {
      const double angle = 2.0 * M_PI * k / kCorners;
      mesh.vertices.emplace_back(radii[k] * std::cos(angle), radii[k] * std::sin(angle), z * kHeight / layers);
    }
  for (int z = 0; z < layers; ++z)
    for (int k = 0; k < kCorners; ++k)
    {
      const int a = z * kCorners + k;
      const int b = z * kCorners + (k + 1) % kCorners;
      mesh.triangles.emplace_back(a, b, b + kCorners);
      mesh.triangles.emplace_back(a, b + kCorners, a + kCorners);
    }
  if (open)
    return mesh;
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  mesh.vertices.emplace_back(0.0, 0.0, kHeight);
  const int bottom = static_cast<int>(mesh.vertices.size()) - 2;
  for (int k = 0; k < kCorners; ++k)
  {
    const int next = (k + 1) % kCorners;
    mesh.triangles.emplace_back(bottom, next, k);
    mesh.triangles.emplace_back(bottom + 1, layers * kCorners + k, layers * kCorners + next);
  }
  return mesh;
}

void expectSignOfTheWindingNumber(const geometry::TriangleMesh& mesh, unsigned seed, const std::string& name)
{
  const Detector detector(mesh, WallLaw{});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> across(-7e-3, 7e-3);
  std::uniform_real_distribution<double> along(-2e-3, 22e-3);
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    const Eigen::Vector3d p(across(random), across(random), along(random));
    const double winding = geometry::windingNumber(mesh, p);
    int triangle = -1;
    const double distance = bruteDistance(detector.wall(), p, triangle);
    EXPECT_NEAR(detector.signedDistance(p), winding > 0.5 ? distance : -distance, 1e-12)
        << name << ", " << p.transpose();
    inside += winding > 0.5;
  }
  EXPECT_GT(inside, 10) << name;
}

TEST(SignedDistance, HasTheSignOfTheWindingNumberAtSharpReflexEdges)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
    expectSignOfTheWindingNumber(starDuct(seed, 2e-3, false), 100 + seed, "duct " + std::to_string(seed));
}

TEST(SignedDistance, HasTheSignOfTheWindingNumberOnSlivers)
{
  for (unsigned seed = 1; seed <= 4; ++seed)  // triangles of 4 mm by 0.02 mm
    expectSignOfTheWindingNumber(starDuct(seed, 2e-5, false), 200 + seed, "slivers " + std::to_string(seed));
}

TEST(SignedDistance, OfAnOpenDuctEqualsThatOfTheClosedDuctNearItsWall)
{
  int compared = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    const Detector open(starDuct(seed, 2e-3, true), WallLaw{});
    const Detector closed(starDuct(seed, 2e-3, false), WallLaw{});
    std::mt19937 random(300 + seed);
    std::uniform_real_distribution<double> across(-7e-3, 7e-3);
    std::uniform_real_distribution<double> along(0.0, 20e-3);
    for (int trial = 0; trial < 300; ++trial)
    {
      const Eigen::Vector3d p(across(random), across(random), along(random));
      // Nearer to the wall than to the ends, so the presence of the end caps does not matter.
      const double to_end = std::min(p.z(), 20e-3 - p.z());
      const double signed_distance = open.signedDistance(p);
      if (std::abs(signed_distance) >= to_end)
        continue;
      EXPECT_EQ(signed_distance, closed.signedDistance(p)) << seed << ", " << p.transpose();
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(SignedDistance, GivesNoContactToANodeBeyondAnOpenEnd)
{
  Detector open(starDuct(3, 2e-3, true), WallLaw{});
  Query query;
  query.margin = {0.5e-3, 0.5e-3};
  query.nodes = {{0.0, 0.0, 1e-3}, {0.0, 0.0, -1e-3}};  // leaves through the middle of the open end
  query.radius = {0.4e-3, 0.4e-3};
  ContactSet set;
  open.detect(query, set);
  EXPECT_TRUE(set.features.empty());
}

}  // namespace
}  // namespace endovascular_sim::contact
