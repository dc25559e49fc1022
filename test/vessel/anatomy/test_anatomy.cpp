#include "vessel/anatomy/anatomy.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "common/error.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::vessel
{
namespace
{

const std::string kFork = std::string(TEST_DATA_DIR) + "/anatomies/fork.yaml";

std::string forkText()
{
  std::ostringstream text;
  text << std::ifstream(kFork).rdbuf();
  return text.str();
}

/** Fork with one replaced text fragment, and the expected error. */
struct Change
{
  const char* name;
  const char* from;
  const char* to;
  const char* key;
  const char* remedy;
};

void PrintTo(const Change& change, std::ostream* out)
{
  *out << change.name;
}

class RejectedAnatomy : public testing::TestWithParam<Change>
{
};

TEST_P(RejectedAnatomy, ReportsFileKeyAndRemedy)
{
  std::string text = forkText();
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  const TemporaryFolder folder;
  const std::string file = folder.write("anatomy.yaml", text);
  const std::string reason = inputErrorOf([&] { sampleChains(readAnatomy(file)); });
  EXPECT_EQ(reason.find(file), 0U) << reason;
  EXPECT_NE(reason.find(GetParam().key), std::string::npos) << reason;
  EXPECT_NE(reason.find(GetParam().remedy), std::string::npos) << reason;
}

INSTANTIATE_TEST_SUITE_P(
    Anatomy, RejectedAnatomy,
    testing::Values(
        Change{"unknown_key", "diameters: [[0, 8]", "diametres: [[0, 8]", "branches[trunk].diametres (line",
               "unknown key"},
        Change{"missing_unit", "unit: 0.001", "", "unit", "missing; give a number in m"},
        Change{"zero_unit", "unit: 0.001", "unit: 0", "unit (line 3)", "is 0; must be between 1e-06 and 1 in m"},
        Change{"negative_diameter", "[1, 7]", "[1, -7]", "branches[trunk].diameters", "a positive diameter"},
        Change{"text_for_number", "[1, 7]", "[1, wide]", "branches[trunk].diameters", "\"wide\" is not"},
        Change{"fraction_above_one", "[1, 7]", "[1.5, 7]", "branches[trunk].diameters",
               "must be a fraction from 0 to 1"},
        Change{"fractions_fall", "[[0, 5], [1, 4]]", "[[1, 5], [0, 4]]", "branches[right].diameters", "must increase"},
        Change{"no_diameters", "[[0, 5], [1, 4]]", "[]", "branches[right].diameters", "at least one"},
        Change{"orphan", "parent: trunk", "parent: stem", "branches[right].parent", "no earlier branch \"stem\""},
        Change{"second_root", "    parent: trunk\n", "", "branches[right].parent",
               "only the first branch has no parent"},
        Change{"both_parents", "parent: trunk", "parent: trunk\n    continues: trunk", "branches[right].continues",
               "keep one of the two"},
        Change{"continued_twice", "parent: trunk", "continues: trunk", "branches[right].continues",
               "already continues that branch"},
        Change{"same_name", "name: right", "name: left", "branches[left].name", "the name of an earlier branch"},
        Change{"two_coordinates", "[0, 2, 25]", "[0, 2]", "branches[trunk].points.1 (line", "a list of 3 numbers"},
        Change{"coinciding_points", "[0, 2, 25]", "[0, 0, 0]", "branches[trunk].points", "points 1 and 2 coincide"},
        Change{"one_point", "[[0, 0, 49], [-12, 0, 66], [-20, 5, 90]]", "[[0, 0, 49]]", "branches[right].points",
               "too few"},
        Change{"occlusion", "reduction: 0.5", "reduction: 1.0", "stenoses[throat].reduction",
               "must be between 0 and 0.95"},
        Change{"stenosis_off_the_branch", "position: 0.6", "position: 1.6", "stenoses[throat].position",
               "must be between 0 and 1"},
        Change{"stenosis_without_length", "length: 12", "length: 0", "stenoses[throat].length", "must be positive"},
        Change{"flat_bulge", "radius: 4", "radius: 0", "bulges[sinus].radius", "must be positive"},
        Change{"facets_of_a_continuation", "continues: trunk", "continues: trunk\n    facets_around: 12",
               "branches[left].facets_around", "belongs to the branch that this one continues"},
        Change{"few_facets", "parent: trunk", "parent: trunk\n    facets_around: 3", "branches[right].facets_around",
               "a whole number between 8 and 64"},
        Change{"hard_bulge", "radius: 4", "radius: 4\n    blend: 0", "bulges[sinus].blend",
               "must be between 0.05 and 3"},
        Change{"landmark_nowhere", "bulges:",
               "landmarks: [{name: end, origin: trunk, branch: top, position: 1}]\nbulges:", "landmarks[end].branch",
               "name one of branches"},
        Change{"landmark_off_the_branch", "bulges:",
               "landmarks: [{name: end, origin: trunk, branch: left, position: 2}]\nbulges:", "landmarks[end].position",
               "must be between 0 and 1"},
        Change{"begins_outside", "[0, 0, 49], [-12", "[9, 0, 49], [-12", "branches[right].points",
               "must lie inside the parent"},
        Change{"too_tight", "[-12, 0, 66], [-20, 5, 90]", "[-12, 0, 66], [-10, 1, 64], [-12, 2, 62]",
               "branches[right].points", "radius of curvature is smaller than"},
        Change{"step_at_the_joint", "diameters: [[1, 6]]", "diameters: [[0, 5], [1, 6]]", "branches[left].diameters",
               "remove that entry"},
        Change{"not_yaml", "name: fork", "name: [fork", "line", "is not valid YAML"},
        Change{"branches_as_text", "branches:\n  - name: trunk", "branches: none\nx:\n  - name: trunk",
               "branches (line", "expected a list"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Anatomy, RejectsAMissingFile)
{
  EXPECT_THROW(readAnatomy("/nowhere/anatomy.yaml"), InputError);
}

TEST(Anatomy, ReadsTheForkInMetres)
{
  const Anatomy anatomy = readAnatomy(kFork);
  ASSERT_EQ(anatomy.branches.size(), 3U);
  EXPECT_NEAR(anatomy.branches[0].points[2].z(), 0.05, 1e-15);
  EXPECT_NEAR(anatomy.branches[0].diameters[0].second, 0.008, 1e-15);
  EXPECT_TRUE(anatomy.branches[1].continues);
  EXPECT_EQ(anatomy.branches[2].parent, 0);
  EXPECT_NEAR(anatomy.bulges[0].radius, 0.004, 1e-15);
}

TEST(Anatomy, HasTheExactCentrelineWithBranchNames)
{
  const Anatomy anatomy = readAnatomy(kFork);
  const CentrelineTree tree = anatomyCentreline(anatomy, sampleChains(anatomy));
  ASSERT_EQ(tree.branches.size(), 3U);
  EXPECT_EQ(tree.branches[2].name, "right");
  EXPECT_EQ(tree.branches[1].parent, 0);
  // Continuations share a point and a radius; the right branch begins on the trunk's centreline.
  EXPECT_EQ(tree.branches[1].points.front(), tree.branches[0].points.back());
  EXPECT_EQ(tree.branches[1].radii.front(), tree.branches[0].radii.back());
  EXPECT_LT((tree.branches[0].points.back() - Eigen::Vector3d(0, 0, 0.05)).norm(), 1e-12);
  EXPECT_NEAR(tree.branches[0].radii.front(), 4e-3, 1e-12);
  EXPECT_NEAR(tree.branches[1].radii.back(), 3e-3, 1e-12);
  const double narrowest = *std::min_element(tree.branches[2].radii.begin(), tree.branches[2].radii.end());
  EXPECT_NEAR(narrowest, 0.5 * 0.5 * (5e-3 - 0.6 * 1e-3), 0.03e-3);
}

TEST(Anatomy, HasItsEndsAtTheRootAndTheTips)
{
  const Anatomy anatomy = readAnatomy(kFork);
  const CentrelineTree tree = anatomyCentreline(anatomy, sampleChains(anatomy));
  const std::vector<CentrelineEnd> ends = centrelineEnds(tree);
  ASSERT_EQ(ends.size(), 3U);
  EXPECT_EQ(ends[0].branch, 0);
  EXPECT_EQ(ends[1].branch, 1);
  EXPECT_EQ(ends[2].branch, 2);
  EXPECT_GT(ends[0].inward.z(), 0.9);
  EXPECT_LT(ends[1].inward.x(), -0.5);
  EXPECT_NEAR(ends[2].inward.norm(), 1.0, 1e-12);
}

TEST(AnatomyFile, NamesTheLandmarksOfFrameCounts)
{
  const Anatomy anatomy = readAnatomy(PROJECT_DIR "/config/anatomies/natural.yaml");
  ASSERT_EQ(anatomy.landmarks.size(), 3U);
  const Landmark& landmark = anatomy.landmarks[2];
  EXPECT_EQ(landmark.name, "RCA");
  EXPECT_EQ(anatomy.branches[static_cast<std::size_t>(landmark.origin)].name, "right_coronary");
  EXPECT_EQ(anatomy.branches[static_cast<std::size_t>(landmark.branch)].name, "posterolateral");
  EXPECT_EQ(landmark.position, 0.25);
}

TEST(AnatomyFile, TakesFacetsOfABranchAndTheBlendingOfABulge)
{
  const auto replaced = [](std::string text, const std::string& from, const std::string& to)
  { return text.replace(text.find(from), from.size(), to); };
  std::string text = replaced(forkText(), "    parent: trunk\n", "    parent: trunk\n    facets_around: 12\n");
  text = replaced(text, "    radius: 4\n", "    radius: 4\n    blend: 0.3\n");
  const TemporaryFolder folder;
  const Anatomy anatomy = readAnatomy(folder.write("anatomy.yaml", text));
  EXPECT_EQ(anatomy.branches[2].facets_around, 12);
  EXPECT_EQ(anatomy.branches[0].facets_around, 0);
  EXPECT_EQ(sampleChains(anatomy)[1].facets_around, 12);
  EXPECT_EQ(anatomy.bulges[0].blend, 0.3);
  EXPECT_EQ(readAnatomy(kFork).bulges[0].blend, readAnatomy(kFork).blend);
}

}  // namespace
}  // namespace endovascular_sim::vessel
