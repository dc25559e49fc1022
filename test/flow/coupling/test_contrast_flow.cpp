#include "flow/coupling/contrast_flow.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "contrast/injection/injector.h"
#include "flow/coupling/flow_engine.h"
#include "test/flow/body/natural_anatomy.h"
#include "test/flow/coupling/tube_volumes.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kStep = 5e-3;
constexpr double kConcentration = 350.0, kViscosity = 10.4e-3;

const vessel::CentrelineTree& centreline()
{
  static const vessel::CentrelineTree tree = naturalCentreline();
  return tree;
}

const Circulation& adult()
{
  static const Circulation circulation = readCirculation(PROJECT_DIR "/config/hemodynamics/adult.yaml");
  return circulation;
}

int branch(const std::string& name)
{
  for (std::size_t b = 0; b < centreline().branches.size(); ++b)
    if (centreline().branches[b].name == name)
      return static_cast<int>(b);
  ADD_FAILURE() << name;
  return 0;
}

/** Engine of the natural anatomy with the volumes of tubes. */
FlowEngine makeEngine(const std::vector<vessel::PlacedLesion>& lesions = {})
{
  const VesselFlowTree vessel =
      vesselFlowTree(centreline(), adult(), {}, branchesWithLesions(centreline().branches.size(), lesions));
  return FlowEngine(centreline(), lesions, adult(), kStep, {},
                    tubeVolumes(contrastCells(vessel, centreline()), centreline()));
}

const FlowEngine& engine()
{
  static const FlowEngine shared = makeEngine();
  return shared;
}

/** A run with an injector whose openings stay in place. */
class Angiogram
{
public:
  explicit Angiogram(FlowEngine flow = engine(), std::vector<LumenProfile> lumens = {}) : flow_(std::move(flow))
  {
    request.controls = {adult().heart.rate, adult().mean_pressure, false};
    request.lumens = std::move(lumens);
  }

  /** @param rate [m³/s] */
  void inject(double volume, double rate, const TreePlace& place, double rise = 0.1)
  {
    injector_.refill();
    injector_.start({volume, rate, rise, kConcentration, kViscosity});
    request.injection.openings = {{place, 1.0}};
  }

  void step()
  {
    const contrast::Dose dose = injector_.advance(kStep);
    request.injection.volume = dose.volume;
    request.injection.concentration = dose.concentration;
    request.injection.viscosity = dose.viscosity;
    flow_.step(request, answer);
    request.state = answer.state;
    ++request.step;
  }

  void rest(double time)
  {
    for (int k = 0; k < static_cast<int>(std::lround(time / kStep)); ++k)
      step();
  }

  double time() const { return kStep * static_cast<double>(request.step); }

  double iodineAt(const TreePlace& place) const
  {
    const int cell = flow_.contrast()->grid().cellAt(place);
    return answer.field.iodine.empty() ? 0.0 : answer.field.iodine.at(static_cast<std::size_t>(cell));
  }

  /** Iodine in the cells for which a predicate of their branch holds [kg]. */
  template <typename Predicate>
  double massIn(Predicate holds) const
  {
    double mass = 0.0;
    const contrast::ContrastCells& cells = flow_.contrast()->grid().cells();
    for (std::size_t k = 0; k < cells.size(); ++k)
      if (holds(cells[k].branch))
        mass += flow_.contrast()->transport().mass(k);
    return mass;
  }

  const FlowEngine& flow() const { return flow_; }

  FlowRequest request;
  FlowAnswer answer;

private:
  FlowEngine flow_;
  contrast::Injector injector_{contrast::kPumpSyringe};
};

/** Place in a branch at a distance behind its beginning outside of its parent's lumen. */
TreePlace behindOstium(const std::string& name, double distance)
{
  const int b = branch(name);
  for (const contrast::ContrastCell& cell : engine().contrast()->grid().cells())
    if (cell.branch == b)
      return {b, cell.begin + distance};
  return {};
}

/** Place at a share of the length of a branch's cells. */
TreePlace along(const std::string& name, double share)
{
  const int b = branch(name);
  double begin = -1.0, end = 0.0;
  for (const contrast::ContrastCell& cell : engine().contrast()->grid().cells())
    if (cell.branch == b)
    {
      begin = begin < 0.0 ? cell.begin : begin;
      end = cell.end;
    }
  return {b, begin + share * (end - begin)};
}

TEST(ContrastFlow, ConservesIodineAndBloodOverSecondsOfPulsesWithReflux)
{
  Angiogram run;
  run.rest(0.5);
  const FlowNetwork& network = run.flow().body().network();
  const double initial = network.totalVolume() - network.entered() + network.left();
  run.inject(8e-6, 6e-6, behindOstium("left_main", 3e-3));
  double aorta = 0.0;
  for (int k = 0; k < 1600; ++k)
  {
    run.step();
    const IodineTotals& totals = run.answer.field.totals;
    ASSERT_LT(std::abs(totals.injected - totals.inside - totals.left), 1e-10 * totals.injected) << k;
    for (const double concentration : run.answer.field.iodine)
    {
      ASSERT_GE(concentration, 0.0) << k;
      ASSERT_LE(concentration, kConcentration) << k;
    }
    aorta = std::max(aorta, run.massIn([](int b) { return b == branch("ascending_aorta"); }));
  }
  EXPECT_NEAR(run.answer.field.totals.injected, 8e-6 * kConcentration, 1e-12);
  EXPECT_GT(aorta, 0.01 * run.answer.field.totals.injected);
  EXPECT_NEAR(network.injected(), 8e-6, 1e-15);
  EXPECT_LT(std::abs(initial + network.entered() + network.injected() - network.left() - network.totalVolume()),
            1e-10 * network.entered());
}

TEST(ContrastFlow, IsWashedOut)
{
  Angiogram run;
  run.inject(5e-6, 4e-6, behindOstium("left_main", 3e-3));
  run.rest(60.0);
  EXPECT_TRUE(run.answer.field.iodine.empty());
  EXPECT_EQ(run.answer.field.totals.inside, 0.0);
  EXPECT_NEAR(run.answer.field.totals.left, run.answer.field.totals.injected, 1e-10 * run.answer.field.totals.injected);
}

TEST(ContrastFlow, WithoutAnInjectionTheFlowHasTheBitsAndTheStateOfAVesselWithoutVolumes)
{
  Angiogram with, without(FlowEngine(centreline(), {}, adult(), kStep, {}));
  for (int k = 0; k < 200; ++k)
  {
    with.step();
    without.step();
    ASSERT_EQ(with.answer.state, without.answer.state) << k;
    ASSERT_EQ(with.answer.field.pressures, without.answer.field.pressures) << k;
  }
  EXPECT_TRUE(with.answer.field.iodine.empty());
}

TEST(ContrastFlow, EachStepIsAFunctionOfItsRequest)
{
  Angiogram pure;
  FlowEngine mixed = engine();
  Angiogram other;
  other.inject(5e-6, 5e-6, behindOstium("right_coronary", 3e-3));
  pure.rest(0.3);
  other.rest(0.3);
  pure.inject(2e-6, 4e-6, behindOstium("left_main", 3e-3));
  for (int k = 0; k < 300; ++k)
  {
    const FlowRequest of_other = other.request, of_pure = pure.request;
    other.step();
    pure.step();
    FlowAnswer answer;
    FlowRequest repeated = of_other;
    repeated.injection = other.request.injection;
    mixed.step(repeated, answer);
    ASSERT_EQ(answer.state, other.answer.state) << k;
    repeated = of_pure;
    repeated.injection = pure.request.injection;
    mixed.step(repeated, answer);
    ASSERT_EQ(answer.state, pure.answer.state) << k;
    ASSERT_EQ(answer.field.iodine, pure.answer.field.iodine) << k;
  }
}

/** Largest difference of the transport's flows to the network's at the middles of its cells, relative to the largest
 *  flow, over a beat. @param scale of all volumes */
double differenceOfFlows(double scale)
{
  const VesselFlowTree vessel = engine().body().vessel();
  std::vector<double> volumes;
  const ContrastGrid& grid = engine().contrast()->grid();
  for (std::size_t k = 0; k < grid.cells().size(); ++k)
    volumes.push_back(scale * (grid.cells()[k].end - grid.cells()[k].begin) *
                      vessel.tree.cells[grid.flowCell(k)].wall.area);
  Angiogram run(FlowEngine(centreline(), {}, adult(), kStep, {}, volumes));
  run.inject(20e-6, 10e-6, {branch("ascending_aorta"), 0.03});
  double difference = 0.0, largest = 0.0;
  for (int k = 0; k < 300; ++k)
  {
    run.step();
    const FlowNetwork& network = run.flow().body().network();
    for (std::size_t cell = 0; cell < grid.cells().size(); ++cell)
    {
      const std::size_t flow_cell = grid.flowCell(cell);
      const bool begins_half =
          cell > 0 && grid.flowCell(cell - 1) == flow_cell && grid.node(cell - 1) != grid.node(cell);
      if (!begins_half)
        continue;
      const double flow = network.meanFlow(flow_cell);
      largest = std::max(largest, std::abs(flow));
      difference = std::max(difference, std::abs(flow - run.flow().contrast()->transport().faceVolume(cell) / kStep));
    }
  }
  return difference / largest;
}

TEST(ContrastFlow, FlowsAsTheNetworkWhereItsVolumesAreThatOfTheNetwork)
{
  EXPECT_LT(differenceOfFlows(1.0), 1e-9);
  const double tenth = differenceOfFlows(1.1);
  testing::Test::RecordProperty("difference_of_flows_10_percent", std::to_string(tenth));
  EXPECT_LT(tenth, 0.1) << "of what vessels store, which is less than the flow";
}

/** Frames between the first one and that in which a landmark is seen, as Gibson et al. 1996 count them. */
struct FrameCount
{
  /** @param begin of the injection [s], of the beat
   *  @param steps after which the count ends, 6 s */
  FrameCount(const FlowEngine& flow, const std::vector<LumenProfile>& lumens, const std::string& ostium,
             const std::vector<TreePlace>& landmarks, double begin, int steps = 1200)
    : frames(landmarks.size(), 0.0)
  {
    Angiogram run(flow, lumens);
    run.rest(begin);
    run.inject(24e-6, 4e-6, behindOstium(ostium, 4e-3));
    const TreePlace origin = behindOstium(ostium, 6e-3);
    double first = -1.0;
    for (int k = 0; k < steps; ++k)
    {
      run.step();
      if (first < 0.0 && run.iodineAt(origin) >= kFull * kConcentration)
        first = run.time();
      for (std::size_t n = 0; n < landmarks.size() && first >= 0.0; ++n)
      {
        const BodyFlow& body = run.flow().body();
        const std::size_t cell = body.cellAt(landmarks[n].branch, landmarks[n].arc);
        const double diameter = 2.0 * std::sqrt(body.vessel().tree.cells[cell].wall.area / M_PI);
        if (frames[n] == 0.0 && run.iodineAt(landmarks[n]) >= kSeen / diameter * kConcentration)
          frames[n] = kRate * (run.time() - first);
      }
    }
  }

  static constexpr double kRate = 30.0;  // [1/s]
  /** A column that is nearly full of concentrated medium over the whole width of the origin. */
  static constexpr double kFull = 0.7;
  /** Diameter of the filled vessel that an angiogram just shows [m]. Medium is seen at a landmark, which it begins to
   *  enter and need not fill, when the vessel there has the same density: 0.5 to 0.7 mm in the test of the transit
   *  times. */
  static constexpr double kSeen = 0.6e-3;

  std::vector<double> frames;  // 0 where the landmark is not reached
};

/** Mean frame counts over four beginnings of the injection in the beat. */
std::vector<double> meanFrames(const FlowEngine& flow, const std::vector<LumenProfile>& lumens,
                               const std::string& ostium, const std::vector<TreePlace>& landmarks)
{
  std::vector<double> mean(landmarks.size(), 0.0);
  constexpr int kBeginnings = 4;
  for (int k = 0; k < kBeginnings; ++k)
  {
    const FrameCount count(flow, lumens, ostium, landmarks,
                           0.5 + static_cast<double>(k) / kBeginnings / adult().heart.rate);
    for (std::size_t n = 0; n < mean.size(); ++n)
    {
      EXPECT_GT(count.frames[n], 0.0) << ostium << ", landmark " << n;
      mean[n] += count.frames[n] / kBeginnings;
    }
  }
  return mean;
}

TEST(ContrastFlow, FrameCountsAreThoseOfNormalArteries)
{
  const std::map<std::string, std::pair<double, double>> normal = {
      {"LAD", {36.0, 9.0}}, {"LCx", {22.0, 6.0}}, {"RCA", {20.0, 5.0}}};
  const vessel::Anatomy anatomy = vessel::readAnatomy(PROJECT_DIR "/config/anatomies/natural.yaml");
  ASSERT_EQ(anatomy.landmarks.size(), normal.size());
  for (const vessel::Landmark& landmark : anatomy.landmarks)
  {
    const auto nameOf = [&anatomy](int b) { return anatomy.branches[static_cast<std::size_t>(b)].name; };
    const double frames =
        meanFrames(engine(), {}, nameOf(landmark.origin), {along(nameOf(landmark.branch), landmark.position)})[0];
    testing::Test::RecordProperty("frames_" + landmark.name, std::to_string(frames));
    const auto& [mean, tolerance] = normal.at(landmark.name);
    EXPECT_NEAR(frames, mean, tolerance) << landmark.name;
  }
}

/** Stenosis of the left anterior descending artery, 30 to 40 mm from its beginning. */
class StenosisOfTheLad
{
public:
  StenosisOfTheLad() : lesion_(placed()), flow_(makeEngine({lesion_}))
  {
    const std::size_t cell = flow_.body().cellAt(lesion_.branch, 0.035);
    healthy_ = flow_.body().vessel().tree.cells[cell].wall.area;
  }

  const FlowEngine& flow() const { return flow_; }

  /** @param reduction of the diameter [1]
   *  @param throat its length; 0.25 mm or more, the length of a part of a cell, are seen in full [m] */
  LumenProfile lumen(double reduction, double throat) const
  {
    const double free = (1.0 - reduction) * (1.0 - reduction) * healthy_, half = 0.5 * throat;
    return {lesion_.branch, {0.03, 0.035 - half, 0.035 + half, 0.04}, {healthy_, free, free, healthy_}};
  }

  /** Lumen of a stent that leaves 10 % of the diameter. */
  LumenProfile stented() const { return {lesion_.branch, {0.03, 0.04}, {0.81 * healthy_, 0.81 * healthy_}}; }

private:
  static vessel::PlacedLesion placed()
  {
    vessel::PlacedLesion lesion;
    lesion.branch = branch("left_anterior_descending");
    lesion.begin = 0.03;
    lesion.end = 0.04;
    return lesion;
  }

  vessel::PlacedLesion lesion_;
  FlowEngine flow_;
  double healthy_ = 0.0;
};

TEST(ContrastFlow, IsSlowBehindASevereStenosis)
{
  const StenosisOfTheLad stenosis;
  const std::vector<TreePlace> landmark = {along("left_anterior_descending", 1.0)};
  const double severe = meanFrames(stenosis.flow(), {stenosis.lumen(0.85, 1e-3)}, "left_main", landmark)[0];
  const double opened = meanFrames(stenosis.flow(), {}, "left_main", landmark)[0];
  testing::Test::RecordProperty("frames_of_85_percent", std::to_string(severe));
  testing::Test::RecordProperty("frames_opened", std::to_string(opened));
  EXPECT_GT(severe, 1.5 * opened);
  EXPECT_NEAR(opened, 36.0, 9.0);
}

/** A trickle passes a stenosis of 95 % of the diameter: the medium enters the artery behind it late, and does not reach
 *  its end in 30 s (TIMI 1, penetration without perfusion). */
TEST(ContrastFlow, IsAtLeastOneAndAHalfTimesSlowerBehindAStenosisOf95PercentAndNormalAfterTheStent)
{
  const StenosisOfTheLad stenosis;
  const std::vector<TreePlace> places = {{branch("left_anterior_descending"), 0.05},  // 1 cm behind the stenosis
                                         along("left_anterior_descending", 1.0)};
  const std::vector<double> severe =
      FrameCount(stenosis.flow(), {stenosis.lumen(0.95, 1e-3)}, "left_main", places, 0.5, 6000).frames;
  const std::vector<double> stented = meanFrames(stenosis.flow(), {stenosis.stented()}, "left_main", places);
  testing::Test::RecordProperty("frames_of_95_percent_1_cm_behind", std::to_string(severe[0]));
  testing::Test::RecordProperty("frames_stented_1_cm_behind", std::to_string(stented[0]));
  testing::Test::RecordProperty("frames_stented", std::to_string(stented[1]));
  EXPECT_GT(severe[0], 1.5 * stented[0]);
  EXPECT_EQ(severe[1], 0.0) << "not in 30 s";
  EXPECT_NEAR(stented[1], 36.0, 9.0);
}

/** Volume flow behind a stenosis over three beats, ml/min. The jet takes nearly all of the pressure. */
TEST(ContrastFlow, IsATrickleBehindAStenosisOf95Percent)
{
  const StenosisOfTheLad stenosis;
  const auto flowBehind = [&](double reduction)
  {
    Angiogram run(stenosis.flow(), {stenosis.lumen(reduction, 1e-3)});
    run.rest(3.0);
    const std::size_t cell = run.flow().body().cellAt(branch("left_anterior_descending"), 0.05);
    constexpr int kSteps = 3 * 171;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k)
    {
      run.step();
      sum += 6e7 * run.flow().body().network().flow(cell) / kSteps;
    }
    testing::Test::RecordProperty("flow_of_" + std::to_string(std::lround(100.0 * reduction)) + "_percent",
                                  std::to_string(sum));
    return sum;
  };
  const double severe = flowBehind(0.90), critical = flowBehind(0.95);
  EXPECT_GT(critical, 0.5);
  EXPECT_LT(critical, 0.4 * severe) << "by the square of the free area, 0.25, and the viscous resistance";
}

/** The network closes a lumen of less than 0.1 % of the healthy area, 97 % of the diameter. */
TEST(ContrastFlow, DoesNotPassAnOcclusion)
{
  const StenosisOfTheLad stenosis;
  EXPECT_EQ(FrameCount(stenosis.flow(), {stenosis.lumen(0.98, 1e-3)}, "left_main",
                       {along("left_anterior_descending", 1.0)}, 0.5)
                .frames[0],
            0.0);
}

TEST(ContrastFlow, AnAortogramHasTheDilutionOfThePumpInTheCardiacOutput)
{
  Angiogram run;
  run.rest(0.5);
  run.inject(60e-6, 15e-6, {branch("ascending_aorta"), 0.015}, 0.3);
  run.rest(2.5);  // until the descending aorta is full
  double mean = 0.0;
  constexpr int kSteps = 171;  // a beat
  for (int k = 0; k < kSteps; ++k)
  {
    run.step();
    mean += run.iodineAt(along("descending_aorta", 0.5)) / kSteps;
  }
  testing::Test::RecordProperty("descending_aorta", std::to_string(mean));
  EXPECT_GT(mean, 35.0);
  EXPECT_LT(mean, 60.0);
}

bool isLeftCoronary(int b)
{
  for (; b >= 0; b = centreline().branches[static_cast<std::size_t>(b)].parent)
    if (centreline().branches[static_cast<std::size_t>(b)].name == "left_main")
      return true;
  return false;
}

/** Share of the iodine of an injection of 1.5 s into the left main artery that flows into the aorta.
 *  @param depth of the tip behind the ostium [m] */
double refluxAt(double rate, double depth)
{
  Angiogram run;
  run.rest(0.5);
  run.inject(1.5 * rate, rate, behindOstium("left_main", depth));
  double outside = 0.0;  // before it leaves the aorta
  for (int k = 0; k < 400; ++k)
  {
    run.step();
    outside = std::max(outside, run.massIn([](int b) { return !isLeftCoronary(b); }));
  }
  return outside / run.answer.field.totals.injected;
}

/** The flow of the artery, 2.4 ml/s in the mean, turns for some milliseconds in the early systole, when less than 0.07
 *  ml of a gentle injection flow back: 4 mm of the artery. */
TEST(ContrastFlow, FlowsBackFromTheLeftMainArteryWhenTooMuchIsInjected)
{
  const double strong = refluxAt(6e-6, 10e-3), gentle = refluxAt(1e-6, 10e-3), shallow = refluxAt(1e-6, 3e-3);
  testing::Test::RecordProperty("reflux_6_ml_s", std::to_string(strong));
  testing::Test::RecordProperty("reflux_1_ml_s", std::to_string(gentle));
  testing::Test::RecordProperty("reflux_1_ml_s_at_the_ostium", std::to_string(shallow));
  EXPECT_NEAR(strong, 1.0 - 2.44 / 6.0, 0.1) << "what the artery does not take";
  EXPECT_LT(gentle, 0.02);
  EXPECT_GT(shallow, 0.02);
}

TEST(ContrastFlow, RefusesInjectionsThatAreNotPossible)
{
  const auto refuses = [](auto change)
  {
    Angiogram run;
    run.request.injection = {1e-8, kConcentration, kViscosity, {{behindOstium("left_main", 3e-3), 1.0}}};
    change(run.request.injection);
    FlowEngine flow = engine();
    FlowAnswer answer;
    EXPECT_THROW(flow.step(run.request, answer), std::invalid_argument);
  };
  refuses([](FlowInjection& i) { i.volume = -1e-8; });
  refuses([](FlowInjection& i) { i.volume = std::nan(""); });
  refuses([](FlowInjection& i) { i.concentration = 0.0; });
  refuses([](FlowInjection& i) { i.viscosity = std::nan(""); });
  refuses([](FlowInjection& i) { i.openings.clear(); });
  refuses([](FlowInjection& i) { i.openings[0].share = 0.0; });
  refuses([](FlowInjection& i) { i.openings[0].place.branch = -1; });
  refuses([](FlowInjection& i) { i.openings[0].place.branch = 999; });
}

TEST(ContrastFlow, RaisesTheVolumesOfCellsWithoutLumenAndRefusesNegativeOnes)
{
  const int cell = engine().contrast()->grid().cellAt(behindOstium("left_main", 8e-3));
  std::vector<double> volumes = tubeVolumes(engine().contrast()->grid().cells(), centreline());
  volumes[static_cast<std::size_t>(cell)] = 0.0;
  Angiogram run(FlowEngine(centreline(), {}, adult(), kStep, {}, volumes));
  run.inject(2e-6, 4e-6, behindOstium("left_main", 3e-3));
  run.rest(0.4);  // still injecting
  const IodineTotals& totals = run.answer.field.totals;
  EXPECT_NEAR(totals.inside + totals.left, totals.injected, 1e-10 * totals.injected);
  EXPECT_GT(run.answer.field.iodine.at(static_cast<std::size_t>(cell)), 300.0);
  volumes[static_cast<std::size_t>(cell)] = -1e-12;
  EXPECT_THROW(FlowEngine(centreline(), {}, adult(), kStep, {}, volumes), std::invalid_argument);
}

TEST(ContrastFlow, IsRefusedWithoutTheVolumesOfTheVessel)
{
  Angiogram run;
  run.inject(1e-6, 4e-6, behindOstium("left_main", 3e-3));
  run.rest(0.1);
  FlowEngine without(centreline(), {}, adult(), kStep, {});
  FlowAnswer answer;
  EXPECT_THROW(without.step(run.request, answer), ArchiveError) << "a state with iodine";
  run.request.state.clear();
  EXPECT_THROW(without.step(run.request, answer), std::invalid_argument);
  EXPECT_THROW(FlowEngine(centreline(), {}, adult(), kStep, {}, {1e-9, 1e-9}), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::flow
