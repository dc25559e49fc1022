#include "flow/body/body_flow.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "test/flow/body/natural_anatomy.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kMmHg = 133.322;             // [Pa]
constexpr double kMlPerMinute = 1e-6 / 60.0;  // [m³/s]

/** Flow in the natural anatomy. */
class NaturalFlow : public testing::Test
{
protected:
  int branch(const std::string& name) const
  {
    for (std::size_t b = 0; b < tree.branches.size(); ++b)
      if (tree.branches[b].name == name)
        return static_cast<int>(b);
    ADD_FAILURE() << name;
    return 0;
  }

  const vessel::CentrelineTree tree = naturalCentreline();
  const Circulation circulation = readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml");
  BodyFlow body{tree, circulation, 5e-3, std::vector<bool>(tree.branches.size(), false)};
};

TEST_F(NaturalFlow, HasTheBloodPressureAndTheCoronaryFlowsOfAnAdultAtRest)
{
  double highest = 0.0, lowest = 1e9, systole = 0.0, diastole = 0.0;
  std::map<std::string, double> flows;
  const unsigned end = body.heart().beats() + 1;
  int samples = 0;
  while (body.heart().beats() < end)
  {
    body.step();
    ++samples;
    highest = std::max(highest, body.rootPressure());
    lowest = std::min(lowest, body.rootPressure());
    for (const char* name : {"left_anterior_descending", "left_circumflex", "right_coronary"})
      flows[name] += body.flowAt(branch(name), 0.0);
    (body.heart().activation() >= 1.0 ? systole : diastole) += body.flowAt(branch("left_anterior_descending"), 0.0);
  }
  for (auto& [name, flow] : flows)
    flow /= samples * kMlPerMinute;
  EXPECT_GT(highest, 105.0 * kMmHg);
  EXPECT_LT(highest, 130.0 * kMmHg);
  EXPECT_GT(lowest, 70.0 * kMmHg);
  EXPECT_LT(lowest, 85.0 * kMmHg);
  EXPECT_TRUE(body.remarks().empty()) << "all outlets have known names, and the rest at the inlet is a thousandth";
  EXPECT_GT(flows["left_anterior_descending"], 70.0);
  EXPECT_LT(flows["left_anterior_descending"], 100.0);
  EXPECT_GT(flows["left_circumflex"], 50.0);
  EXPECT_LT(flows["left_circumflex"], 75.0);
  EXPECT_GT(flows["right_coronary"], 100.0);
  EXPECT_LT(flows["right_coronary"], 140.0);
  EXPECT_GT(diastole, 0.65 * (systole + diastole));
}

/** Lesion of 12 mm in the proximal left anterior descending artery, of the shape of addLesions(). */
LumenProfile lesion(const BodyFlow& body, int branch, double grade)
{
  constexpr double kMiddle = 0.02, kLength = 0.012;
  const double healthy = body.vessel().tree.cells[body.cellAt(branch, kMiddle)].wall.area;
  LumenProfile profile;
  profile.branch = branch;
  for (int k = -24; k <= 24; ++k)
  {
    const double x = kLength * k / 48.0;
    profile.arcs.push_back(kMiddle + x);
    profile.areas.push_back(healthy * std::pow(1.0 - 0.5 * grade * (1.0 + std::cos(2.0 * M_PI * x / kLength)), 2));
  }
  return profile;
}

/** Mean pressure behind a lesion relative to that in the aorta, in hyperaemia. */
double fractionalFlowReserve(BodyFlow& body, int branch)
{
  double distal = 0.0, aortic = 0.0;
  const unsigned begin = body.heart().beats() + 10, end = begin + 2;
  while (body.heart().beats() < end)
  {
    body.step();
    if (body.heart().beats() < begin)
      continue;
    distal += body.pressureAt(branch, 0.04);
    aortic += body.rootPressure();
  }
  return distal / aortic;
}

TEST(BodyFlow, OfAVesselWithoutAnAortaHasThePulseOfOne)
{
  vessel::CentrelineTree tree;
  tree.branches.push_back(
      {"left_main", -1, {{0.0, 0.0, 0.0}, {0.025, 0.0, 0.0}, {0.05, 0.0, 0.0}}, {2e-3, 2e-3, 2e-3}});
  BodyFlow body(tree, readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml"), 5e-3, {false});
  double highest = 0.0, lowest = 1e9;
  const unsigned end = body.heart().beats() + 2;
  while (body.heart().beats() < end)
  {
    body.step();
    highest = std::max(highest, body.rootPressure());
    lowest = std::min(lowest, body.rootPressure());
  }
  EXPECT_GT(highest, 105.0 * kMmHg);
  EXPECT_LT(highest, 150.0 * kMmHg);
  EXPECT_GT(lowest, 55.0 * kMmHg);
  EXPECT_LT(lowest, 85.0 * kMmHg);
}

TEST_F(NaturalFlow, HasTheFractionalFlowReserveOfAStenosis)
{
  const int lad = branch("left_anterior_descending");
  std::vector<bool> fine(tree.branches.size(), false);
  fine[static_cast<std::size_t>(lad)] = true;
  const struct
  {
    double grade, lowest, highest;
  } rows[] = {{0.0, 0.95, 1.0}, {0.5, 0.82, 0.92}, {0.6, 0.70, 0.82}, {0.7, 0.50, 0.70}};
  std::vector<double> reference;
  for (const double time_step : {5e-3, 1e-2, 1e-3})
  {
    BodyFlow flow(tree, circulation, time_step, fine);
    flow.setHyperaemia(true);
    std::vector<double> found;
    for (const auto& row : rows)
    {
      flow.setObstruction({lesion(flow, lad, row.grade)}, {});
      found.push_back(fractionalFlowReserve(flow, lad));
      EXPECT_GT(found.back(), row.lowest) << row.grade << ", " << time_step;
      EXPECT_LT(found.back(), row.highest) << row.grade << ", " << time_step;
    }
    if (reference.empty())
      reference = found;
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k], reference[k], 0.01) << time_step;
    flow.setObstruction({}, {});
    EXPECT_GT(fractionalFlowReserve(flow, lad), 0.95) << "behind a stent";
  }
  BodyFlow flow(tree, circulation, 2.5e-4, fine);
  flow.setHyperaemia(true);
  flow.setObstruction({lesion(flow, lad, 0.6)}, {});
  EXPECT_NEAR(fractionalFlowReserve(flow, lad), reference[2], 0.01);
}

TEST_F(NaturalFlow, DampsThePressureInFrontOfACatheterThatBlocksTheLeftMainArtery)
{
  const int left_main = branch("left_main"), lad = branch("left_anterior_descending");
  double radius = 1.0;
  for (std::size_t k = 0; k < body.vessel().places.size(); ++k)
    if (body.vessel().places[k].branch == left_main)
      radius = std::min(radius, std::sqrt(body.vessel().tree.cells[k].wall.area / M_PI));
  body.setObstruction({}, {{left_main, 0.0, 1.0, std::sqrt(0.95) * radius}});
  double systole = 0.0, diastole = 1e9;
  const unsigned begin = body.heart().beats() + 15;
  while (body.heart().beats() < begin + 1)
  {
    body.step();
    if (body.heart().beats() < begin)
      continue;
    systole = std::max(systole, body.pressureAt(lad, 0.0));
    diastole = std::min(diastole, body.pressureAt(lad, 0.0));
  }
  RecordProperty("systole_mmHg", std::to_string(systole / kMmHg));
  EXPECT_GT(systole, 60.0 * kMmHg);
  EXPECT_LT(systole, 95.0 * kMmHg);
  EXPECT_LT(diastole, 25.0 * kMmHg);
  EXPECT_GT(diastole, 0.0);
}

TEST_F(NaturalFlow, HasThePressureBeyondTheAnnulusAtTheTipOfACatheterWithinACell)
{
  const int left_main = branch("left_main");
  const std::size_t cell = body.cellAt(left_main, 0.015);
  const CellPlace& place = body.vessel().places[cell];
  const FlowCell& ends = body.vessel().tree.cells[cell];
  const double radius = std::sqrt(0.95 * ends.wall.area / M_PI);
  const double tip = place.begin + 0.25 * (place.end - place.begin);
  for (const bool is_from_heart : {true, false})
  {
    body.setObstruction({}, {is_from_heart ? InstrumentSpan{left_main, place.begin, tip, radius}
                                           : InstrumentSpan{left_main, tip, place.end, radius}});
    double largest = 0.0;
    for (int k = 0; k < 1000; ++k)
    {
      body.step();
      const double from = body.network().pressure(static_cast<std::size_t>(ends.from));
      const double to = body.network().pressure(static_cast<std::size_t>(ends.to));
      const double far = is_from_heart ? to : from;
      ASSERT_NEAR(body.pressureAt(left_main, tip), far, 0.02 * std::abs(from - to)) << k;
      ASSERT_NEAR(body.pressureAt(left_main, place.begin), from, 1e-6 * std::abs(from));
      largest = std::max(largest, from - to);
    }
    EXPECT_GT(largest, 20.0 * kMmHg);
  }
}

TEST_F(NaturalFlow, HasNoPressureInAClosedAortaThatAHeartCannotReach)
{
  body.setObstruction({}, {{branch("ascending_aorta"), 0.0, 0.1, 0.05}});
  double highest = 0.0;
  for (const unsigned end = body.heart().beats() + 20; body.heart().beats() < end; body.step())
    highest = std::max(highest, body.rootPressure());
  RecordProperty("highest_mmHg", std::to_string(highest / kMmHg));
  EXPECT_GT(highest, 200.0 * kMmHg);
  EXPECT_LT(highest, 1.5 * body.circulation().heart.largest_pressure);
}

TEST_F(NaturalFlow, HasThePressureOfItsSideOfAClosedPlace)
{
  const int left_main = branch("left_main");
  const std::size_t cell = body.cellAt(left_main, 0.015);
  const CellPlace& place = body.vessel().places[cell];
  const FlowCell& ends = body.vessel().tree.cells[cell];
  const double length = place.end - place.begin;
  body.setObstruction({}, {{left_main, place.begin + 0.4 * length, place.begin + 0.6 * length, 5e-3}});
  for (int k = 0; k < 500; ++k)
    body.step();
  const auto pressure = [this](int node) { return body.network().pressure(static_cast<std::size_t>(node)); };
  EXPECT_GT(pressure(ends.from), pressure(ends.to) + 20.0 * kMmHg);
  EXPECT_EQ(body.pressureAt(left_main, place.begin + 0.3 * length), pressure(ends.from));
  EXPECT_EQ(body.pressureAt(left_main, place.begin + 0.7 * length), pressure(ends.to));
}

TEST_F(NaturalFlow, ContinuesFromAnArchiveWithEqualBits)
{
  const int lad = branch("left_anterior_descending");
  const auto change = [&](BodyFlow& flow, int step)
  {
    if (step % 100 == 30)
      flow.heart().setRate(step % 300 == 130 ? 0.0 : 0.7 + 0.004 * step);
    if (step % 100 == 50)
      flow.setHyperaemia(step % 200 == 50);
    if (step % 100 == 70)
      flow.setMeanPressure(9e3 + 8.0 * step);
    if (step % 100 == 90)
      flow.setObstruction({lesion(flow, lad, 0.6)}, {{lad, 0.0, 1e-4 * step, 8e-4}});
    flow.step();
  };
  for (int k = 0; k < 700; ++k)
    change(body, k);
  Archive written;
  body.archive(written);
  RecordProperty("bytes", std::to_string(written.bytes().size()));
  BodyFlow other(tree, circulation, 5e-3, std::vector<bool>(tree.branches.size(), false));
  other.heart().setRate(2.0);
  other.setMeanPressure(2e4);
  for (int k = 0; k < 50; ++k)
    other.step();
  Archive read(written.bytes());
  other.archive(read);
  EXPECT_TRUE(read.atEnd());
  other.setObstruction({lesion(other, lad, 0.6)}, {{lad, 0.0, 1e-4 * 690, 8e-4}});
  EXPECT_EQ(other.isHyperaemic(), body.isHyperaemic());
  EXPECT_EQ(other.meanPressure(), body.meanPressure());
  for (int k = 700; k < 1000; ++k)
  {
    change(body, k);
    change(other, k);
    for (std::size_t cell = 0; cell < body.vessel().places.size(); ++cell)
      ASSERT_EQ(body.network().flow(cell), other.network().flow(cell)) << k;
    for (std::size_t node = 0; node <= body.vessel().places.size(); ++node)
    {
      ASSERT_EQ(body.network().pressure(node), other.network().pressure(node)) << k;
      ASSERT_EQ(body.network().volume(node), other.network().volume(node)) << k;
    }
    ASSERT_EQ(body.network().left(), other.network().left()) << k;
    ASSERT_EQ(body.ventriclePressure(), other.ventriclePressure()) << k;
  }
}

TEST_F(NaturalFlow, RefusesAnArchiveOfAnotherVessel)
{
  BodyFlow fine(tree, circulation, 5e-3, std::vector<bool>(tree.branches.size(), true));
  Archive written;
  fine.archive(written);
  Archive read(written.bytes());
  EXPECT_THROW(body.archive(read), ArchiveError);
}

TEST_F(NaturalFlow, FollowsTheMeanPressureThatATeacherSets)
{
  const auto mean = [this]
  {
    double sum = 0.0;
    int samples = 0;
    const unsigned begin = body.heart().beats() + 10;
    for (; body.heart().beats() <= begin; body.step())
      if (body.heart().beats() == begin)
      {
        sum += body.rootPressure();
        ++samples;
      }
    return sum / samples;
  };
  EXPECT_NEAR(mean(), circulation.mean_pressure, 0.01 * circulation.mean_pressure);
  body.setMeanPressure(8e3);
  EXPECT_NEAR(mean(), 8e3, 0.1 * 8e3);
}

}  // namespace
}  // namespace endovascular_sim::flow
