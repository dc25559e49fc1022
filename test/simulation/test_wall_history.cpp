#include "simulation/wall_history.h"

#include <vector>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "intervention/vessel_dilatation.h"

namespace endovascular_sim::simulation
{
namespace
{

/** Displacement of one vertex along x. */
intervention::WallDisplacement displacementTo(double x)
{
  return {{0}, {{x, 0.0, 0.0}}};
}

TEST(WallHistory, CountsVersionsAndAppliesThemInOrder)
{
  WallHistory<intervention::WallDisplacement> history;
  EXPECT_EQ(history.newest(), 1U);
  for (int k = 0; k < 4; ++k)
    EXPECT_EQ(history.append(displacementTo(0.1 * k)), static_cast<std::uint64_t>(k + 2));
  std::vector<std::uint64_t> versions;
  std::vector<double> positions;
  history.advanceTo(4,
                    [&](std::uint64_t version, const intervention::WallDisplacement& displacement)
                    {
                      versions.push_back(version);
                      positions.push_back(displacement.positions.front().x());
                    });
  EXPECT_EQ(versions, (std::vector<std::uint64_t>{2, 3, 4}));
  EXPECT_EQ(positions, (std::vector<double>{0.0, 0.1, 0.2}));
  EXPECT_EQ(history.base(), 4U);
  EXPECT_EQ(history.newest(), 5U);
  ASSERT_EQ(history.pending().size(), 1U);
  EXPECT_EQ(history.pending().front().version, 5U);
}

TEST(WallHistory, AppliesNoVersionTwice)
{
  WallHistory<intervention::WallDisplacement> history;
  history.append(displacementTo(0.1));
  int applied = 0;
  for (int k = 0; k < 3; ++k)
    history.advanceTo(2, [&](std::uint64_t, const intervention::WallDisplacement&) { ++applied; });
  EXPECT_EQ(applied, 1);
  EXPECT_TRUE(history.pending().empty());
}

TEST(WallHistory, IsRestoredFromAnArchive)
{
  WallHistory<intervention::WallDisplacement> history;
  for (int k = 0; k < 3; ++k)
    history.append(displacementTo(0.1 * k));
  history.advanceTo(2, [](std::uint64_t, const intervention::WallDisplacement&) {});
  Archive saved;
  saved(history);
  WallHistory<intervention::WallDisplacement> restored;
  Archive reader(saved.bytes());
  reader(restored);
  EXPECT_TRUE(reader.atEnd());
  EXPECT_EQ(restored.newest(), history.newest());
  EXPECT_EQ(restored.base(), history.base());
  ASSERT_EQ(restored.pending().size(), history.pending().size());
  EXPECT_EQ(restored.pending().back().displacement.positions, history.pending().back().displacement.positions);
}

}  // namespace
}  // namespace endovascular_sim::simulation
