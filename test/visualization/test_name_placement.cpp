#include "visualization/name_placement.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::visualization
{
namespace
{

/** View from the front over the origin; a metre there has 800 pixels. */
PictureView viewFromTheFront()
{
  PictureView view;
  view.eye = {0.0, -1.0, 0.0};
  return view;
}

BranchToName branch(const std::string& name, const Eigen::Vector3d& begin, const Eigen::Vector3d& end,
                    double radius = 4e-3)
{
  BranchToName branch{name, {6.0 + 6.2 * static_cast<double>(name.size()), 15.0}, {}, {}};
  for (int k = 0; k <= 50; ++k)
  {
    branch.points.emplace_back(begin + k / 50.0 * (end - begin));
    branch.radii.push_back(radius);
  }
  return branch;
}

/** An iliac fork: its branches are closer than their names are wide. */
std::vector<BranchToName> fork()
{
  return {branch("abdominal aorta", {0, 0, 0.2}, {0, 0, 0}),
          branch("right common iliac", {0, 0, 0}, {-0.03, 0, -0.06}),
          branch("left common iliac", {0, 0, 0}, {0.03, 0, -0.06}),
          branch("right external iliac", {-0.03, 0, -0.06}, {-0.05, 0, -0.12}),
          branch("left external iliac", {0.03, 0, -0.06}, {0.05, 0, -0.12}),
          branch("right internal iliac", {-0.03, 0, -0.06}, {-0.025, 0.02, -0.1}),
          branch("left internal iliac", {0.03, 0, -0.06}, {0.025, 0.02, -0.1})};
}

std::vector<BranchToName> naturalAnatomy()
{
  const vessel::Anatomy anatomy = vessel::readAnatomy("config/anatomies/natural.yaml");
  std::vector<BranchToName> branches;
  for (const vessel::CentrelineBranch& from :
       vessel::anatomyCentreline(anatomy, vessel::sampleChains(anatomy)).branches)
    branches.push_back({from.name, {6.0 + 6.2 * static_cast<double>(from.name.size()), 15.0}, from.points, from.radii});
  return branches;
}

/** View from a direction towards a point. */
PictureView viewOf(const Eigen::Vector3d& focus, double distance, double yaw, double width, double height)
{
  PictureView view;
  view.forward = {-std::sin(yaw), std::cos(yaw), 0.0};
  view.right = {std::cos(yaw), std::sin(yaw), 0.0};
  view.eye = focus - distance * view.forward;
  view.width = width;
  view.height = height;
  view.focal = 0.5 * height / std::tan(0.5 * 0.785);
  view.reach = 1.5 * distance;
  return view;
}

/** Distance of a drawn branch from a rectangle, by brute force; infinite outside of the view. */
double drawnDistance(const BranchToName& branch, const Rectangle& box, const PictureView& view)
{
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < branch.points.size(); ++i)
    for (int k = 0; k < 40; ++k)
    {
      const Eigen::Vector3d point = branch.points[i] + k / 40.0 * (branch.points[i + 1] - branch.points[i]);
      if (view.depth(point) < 6e-3)
        continue;
      const Eigen::Vector2d place = view.project(point);
      if (std::abs(place.x()) > 0.5 * view.width || std::abs(place.y()) > 0.5 * view.height)
        continue;
      const double radius = branch.radii[i] * view.focal / view.depth(point);
      least = std::min(least, std::max(box.distance(place) - radius, 0.0));
    }
  return least;
}

/** Distance of a point from the centreline of a branch, relative to the radius there. */
double distanceInRadii(const BranchToName& branch, const Eigen::Vector3d& point)
{
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < branch.points.size(); ++i)
  {
    const Eigen::Vector3d along = branch.points[i + 1] - branch.points[i];
    const double share = std::clamp(along.dot(point - branch.points[i]) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (branch.points[i] + share * along - point).norm() / branch.radii[i]);
  }
  return least;
}

/** Checks that each name belongs visibly to its own branch, and overlaps nothing. */
void expectReadable(const std::vector<PlacedName>& names, const std::vector<BranchToName>& branches,
                    const PictureView& view)
{
  for (const PlacedName& name : names)
  {
    const Rectangle box = name.box(view);
    const auto own = std::find_if(branches.begin(), branches.end(),
                                  [&](const BranchToName& branch) { return branch.text == name.text; });
    ASSERT_NE(own, branches.end());
    EXPECT_LT(distanceInRadii(*own, name.end), 0.7) << name.text << ": its leader ends beside its branch";
    for (const BranchToName& other : branches)
      EXPECT_TRUE(&other == &*own || drawnDistance(other, {view.project(name.end), view.project(name.end)}, view) > 0.0)
          << "the leader of " << name.text << " ends at " << other.text;
    const double own_distance = drawnDistance(*own, box, view);
    for (const BranchToName& other : branches)
    {
      if (&other == &*own)
        continue;
      EXPECT_GT(drawnDistance(other, box, view), own_distance) << name.text << " stands at " << other.text;
    }
    EXPECT_TRUE((box.low.array() > -0.5 * Eigen::Array2d(view.width, view.height)).all()) << name.text;
    EXPECT_TRUE((box.high.array() < 0.5 * Eigen::Array2d(view.width, view.height)).all()) << name.text;
    for (const PlacedName& other : names)
    {
      if (&other == &name)
        continue;
      EXPECT_FALSE(box.overlaps(other.box(view))) << name.text << ", " << other.text;
    }
  }
}

const PlacedName* find(const std::vector<PlacedName>& names, const std::string& text)
{
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const PlacedName& name) { return name.text == text; });
  return found == names.end() ? nullptr : &*found;
}

TEST(NamePlacement, NamesOfAForkStandAtTheirOwnBranches)
{
  const std::vector<PlacedName> names = placeNames(fork(), viewFromTheFront());
  EXPECT_EQ(names.size(), 5U);  // between the external arteries there is no room for the names of the internal ones
  expectReadable(names, fork(), viewFromTheFront());
}

TEST(NamePlacement, NamesOfTheWholeAnatomyStandAtTheirOwnBranches)
{
  const std::vector<BranchToName> branches = naturalAnatomy();
  for (const double yaw : {0.0, 0.7, -0.5, 1.5})
    for (const double width : {436.0, 818.0, 1100.0})
    {
      const PictureView view = viewOf({0.0, 0.0, 0.2}, 1.35, yaw, width, width == 1100.0 ? 1000.0 : 700.0);
      const std::vector<PlacedName> names = placeNames(branches, view);
      EXPECT_GT(names.size(), 12U) << yaw << ", " << width;
      expectReadable(names, branches, view);
    }
}

TEST(NamePlacement, NamesNearTheTipStandAtTheirOwnBranches)
{
  const std::vector<BranchToName> branches = naturalAnatomy();
  std::size_t named = 0;
  for (const BranchToName& branch : branches)
    for (const double share : {0.1, 0.5, 0.9})
    {
      const auto at = static_cast<std::size_t>(share * static_cast<double>(branch.points.size() - 1));
      const PictureView view = viewOf(branch.points[at], 0.08, 0.0, 436.0, 710.0);
      const std::vector<PlacedName> names = placeNames(branches, view);
      named += names.size();
      expectReadable(names, branches, view);
    }
  EXPECT_GT(named, 3 * branches.size());
}

TEST(NamePlacement, CarotidAndBrachiocephalicAreNotExchanged)
{
  const std::vector<BranchToName> branches = naturalAnatomy();
  const PictureView view = viewOf({0.0, 0.0, 0.2}, 1.35, 0.0, 436.0, 710.0);
  const std::vector<PlacedName> names = placeNames(branches, view);
  for (const char* text : {"left_common_carotid", "brachiocephalic", "abdominal_aorta"})
  {
    const PlacedName* name = find(names, text);
    ASSERT_NE(name, nullptr) << text;
    for (const BranchToName& branch : branches)
      EXPECT_EQ(distanceInRadii(branch, name->end) < 1.0, branch.text == text) << text << ", " << branch.text;
  }
}

TEST(NamePlacement, BranchesBeyondTheReachHaveNoName)
{
  std::vector<BranchToName> branches = fork();
  branches.push_back(branch("far behind", {0.6, 0.5, -0.1}, {0.6, 0.5, 0.1}));
  PictureView view = viewFromTheFront();
  EXPECT_NE(find(placeNames(branches, view), "far behind"), nullptr);
  view.reach = 1.2;
  const std::vector<PlacedName> names = placeNames(branches, view);
  EXPECT_EQ(find(names, "far behind"), nullptr);
  EXPECT_EQ(names.size(), placeNames(fork(), viewFromTheFront()).size());
}

TEST(NamePlacement, TheBranchThatComesFirstHasAPlaceBeforeTheOthers)
{
  std::vector<BranchToName> branches{branch("first", {-0.1, 0, -0.2}, {-0.1, 0, 0.2}),
                                     branch("second", {0, 0, -0.1}, {0, 0, 0.1})};
  PictureView view = viewFromTheFront();
  view.width = 200.0;
  const std::vector<PlacedName> names = placeNames(branches, view);
  ASSERT_EQ(names.size(), 2U);
  EXPECT_EQ(names[0].text, "first") << "the longest one";
  branches[1].comes_first = true;
  EXPECT_EQ(placeNames(branches, view)[0].text, "second");
}

TEST(NamePlacement, NamesOfThePictureBeforeAreNotCutByItsEdges)
{
  PictureView view = viewFromTheFront();
  view.width = 300.0;
  const std::vector<PlacedName> before = placeNames(fork(), view);
  ASSERT_FALSE(before.empty());
  for (const double step : {-0.3, -0.02, 0.0, 0.02, 0.3})
  {
    view.eye.x() = step;
    for (const PlacedName& name : before)
    {
      const Rectangle box = name.boxInside(view);
      EXPECT_TRUE((box.low.array() >= -0.5 * Eigen::Array2d(view.width, view.height) - 1e-9).all()) << name.text;
      EXPECT_TRUE((box.high.array() <= 0.5 * Eigen::Array2d(view.width, view.height) + 1e-9).all()) << name.text;
      EXPECT_LT((box.high - box.low - name.size).norm(), 1e-9);
      PictureView with_legends = view;
      with_legends.legend_width = view.width;
      with_legends.legend_height = 0.4 * view.height;
      EXPECT_GE(name.boxInside(with_legends).low.y(), -0.1 * view.height - 1e-9) << name.text;
      EXPECT_TRUE(step != 0.0 || (box.low - name.box(view).low).norm() < 1e-12) << "in the picture already";
    }
  }
}

TEST(NamePlacement, NamesKeepTheirPlacesWhileTheCameraMovesALittle)
{
  const std::vector<BranchToName> branches = fork();
  const std::vector<PlacedName> before = placeNames(branches, viewFromTheFront());
  PictureView view = viewFromTheFront();
  view.eye.x() += 0.02;
  const std::vector<PlacedName> names = placeNames(branches, view, before);
  ASSERT_EQ(names.size(), before.size());
  for (const PlacedName& name : names)
    EXPECT_EQ(name.offset, find(before, name.text)->offset) << name.text;
  expectReadable(names, branches, view);
}

TEST(NamePlacement, NamesAvoidTheLegendsAtTheLowerLeft)
{
  PictureView view = viewFromTheFront();
  view.legend_width = view.width;
  view.legend_height = 0.5 * view.height;
  const std::vector<PlacedName> names = placeNames(fork(), view);
  EXPECT_LT(names.size(), placeNames(fork(), viewFromTheFront()).size());
  EXPECT_FALSE(names.empty());
  for (const PlacedName& name : names)
    EXPECT_GT(name.box(view).low.y(), 0.0) << name.text;
}

TEST(NamePlacement, NamesStayInASmallPicture)
{
  PictureView view = viewFromTheFront();
  view.width = 300.0;
  view.height = 200.0;
  expectReadable(placeNames(fork(), view), fork(), view);
}

TEST(NamePlacement, AThickBranchThatFillsThePictureCarriesItsName)
{
  const std::vector<BranchToName> branches{branch("aorta", {0, 0, -1}, {0, 0, 1}, 0.6)};
  const std::vector<PlacedName> names = placeNames(branches, viewFromTheFront());
  ASSERT_EQ(names.size(), 1U);
  expectReadable(names, branches, viewFromTheFront());
}

TEST(NamePlacement, ShortHiddenAndEmptyBranchesHaveNoName)
{
  const std::vector<BranchToName> branches{branch("short", {0, 0, 0}, {0, 0, 0.01}),
                                           branch("behind the eye", {0, -2, 0}, {0, -2, 0.5}),
                                           branch("", {0, 0, 0}, {0, 0, 0.1}),
                                           {"without points", {80.0, 16.0}, {}, {}}};
  EXPECT_TRUE(placeNames(branches, viewFromTheFront()).empty());
  EXPECT_TRUE(placeNames({}, viewFromTheFront()).empty());
}

}  // namespace
}  // namespace endovascular_sim::visualization
