#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "flow/network/flow_network.h"
#include "yaml/tree.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;

/** Periodic curve by its points. */
struct Curve
{
  std::vector<double> times, values;

  double at(double time) const
  {
    const double period = times.back() - times.front();
    const double t = times.front() + std::fmod(std::fmod(time - times.front(), period) + period, period);
    const auto after = std::upper_bound(times.begin(), times.end(), t);
    const std::size_t k = std::min<std::size_t>(std::max<std::ptrdiff_t>(after - times.begin(), 1), times.size() - 1);
    return values[k - 1] + (values[k] - values[k - 1]) * (t - times[k - 1]) / (times[k] - times[k - 1]);
  }

  double mean() const
  {
    double area = 0.0;
    for (std::size_t k = 1; k < times.size(); ++k)
      area += 0.5 * (values[k] + values[k - 1]) * (times[k] - times[k - 1]);
    return area / (times.back() - times.front());
  }
};

/** Reads a column of a table of numbers, separated by blanks or commas. */
Curve readCurve(const std::filesystem::path& file, int column)
{
  Curve curve;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
  {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double time = 0.0, value = 0.0;
    words >> time;
    for (int k = 0; k < column; ++k)
      words >> value;
    curve.times.push_back(time);
    curve.values.push_back(value);
  }
  return curve;
}

/** Benchmarks of Boileau et al. 2015, with waveforms of openBF: third-party data that the repository does not hold. */
class Boileau : public testing::Test
{
protected:
  void SetUp() override
  {
    const char* data = std::getenv("ENDOVASCULAR_DATA_DIR");
    if (data != nullptr)
      folder = std::filesystem::path(data).lexically_normal() / ".." / "haemodynamics";
    if (data == nullptr || !std::filesystem::exists(folder / "cca.yaml"))
      GTEST_SKIP() << "no folder haemodynamics beside ENDOVASCULAR_DATA_DIR";
  }

  /** Root mean square of the difference of a simulated beat to a reference, relative to its values or to its largest.
   */
  static double difference(const Curve& found, const Curve& reference, bool is_pressure)
  {
    double sum = 0.0, largest = 0.0;
    for (const double value : reference.values)
      largest = std::max(largest, std::abs(value));
    for (std::size_t k = 0; k < reference.times.size(); ++k)
    {
      const double scale = is_pressure ? reference.values[k] : largest;
      sum += std::pow((found.at(reference.times[k]) - reference.values[k]) / scale, 2);
    }
    return std::sqrt(sum / static_cast<double>(reference.times.size()));
  }

  std::filesystem::path folder;
};

/** Uniform vessel of a benchmark. */
void append(FlowTree& tree, int from, double length, double radius, double modulus_thickness, double profile, int cells)
{
  const int segment = tree.cells.empty() ? 0 : tree.cells.back().segment + 1;
  for (int k = 0; k < cells; ++k)
  {
    FlowCell cell;
    cell.from = from;
    cell.to = from = tree.nodes++;
    cell.segment = segment;
    cell.length = length / cells;
    cell.wall = {kPi * radius * radius, 4.0 / 3.0 * modulus_thickness / radius};
    cell.profile = profile;
    tree.cells.push_back(cell);
  }
}

/** Last one of several beats: pressure at nodes and flow in cells. */
struct Beat
{
  std::vector<Curve> pressures, flows;
};

Beat lastBeat(FlowNetwork& network, const Curve& inlet, int beats, const std::vector<std::size_t>& nodes,
              const std::vector<std::size_t>& cells)
{
  Beat beat;
  beat.pressures.resize(nodes.size());
  beat.flows.resize(cells.size());
  const double step = network.settings().time_step, period = inlet.times.back();
  const std::vector<double> back(network.tree().outlets.size(), 0.0);
  const int steps = static_cast<int>(std::lround(beats * period / step));
  for (int k = 1; k <= steps; ++k)
  {
    network.step(inlet.at(k * step), back);
    if (k * step < (beats - 1) * period - 0.5 * step)
      continue;
    const auto add = [&](Curve& curve, double value)
    {
      curve.times.push_back(k * step);
      curve.values.push_back(value);
    };
    for (std::size_t n = 0; n < nodes.size(); ++n)
      add(beat.pressures[n], network.pressure(nodes[n]));
    for (std::size_t c = 0; c < cells.size(); ++c)
      add(beat.flows[c], network.flow(cells[c]));
  }
  return beat;
}

TEST_F(Boileau, HasThePressureAndTheFlowOfTheCommonCarotidArtery)
{
  FlowTree tree;
  append(tree, 0, 0.126, 2.6485e-3, 700e3 * 0.24e-3, 2.0, 25);
  tree.outlets.push_back({25, 2.4875e8, 1.8697e9, 1.7529e-10});
  FlowNetwork network(tree, {}, 0.0);
  const Beat beat = lastBeat(network, readCurve(folder / "cca_inlet.dat", 1), 8, {0, 13, 25}, {12});
  for (const auto& [place, column] : {std::pair(0, 1), std::pair(1, 3), std::pair(2, 5)})
    EXPECT_LT(difference(beat.pressures[place], readCurve(folder / "cca_P.csv", column), true), 0.004) << place;
  EXPECT_LT(difference(beat.flows[0], readCurve(folder / "cca_Q.csv", 3), false), 0.003);
}

TEST_F(Boileau, HasThePressureAndTheFlowOfTheAorticBifurcation)
{
  FlowTree tree;
  append(tree, 0, 0.086, 7.581e-3, 500e3 * 0.9e-3, 9.0, 17);
  for (int daughter = 0; daughter < 2; ++daughter)
  {
    append(tree, 17, 0.085, 5.492e-3, 700e3 * 0.68e-3, 9.0, 17);
    tree.outlets.push_back({tree.nodes - 1, 6.8123e7, 3.1013e9, 3.6664e-10});
  }
  FlowNetwork network(tree, {}, 0.0);
  const Curve inlet = readCurve(folder / "ibif_inlet.dat", 1);
  const Beat beat = lastBeat(network, inlet, 14, {0, 8, 26}, {8, 25});
  const Curve parent = readCurve(folder / "ibif_parent_P.csv", 3), daughter = readCurve(folder / "ibif_d1_P.csv", 3);
  EXPECT_LT(difference(beat.pressures[1], parent, true), 0.015);
  EXPECT_LT(difference(beat.pressures[2], daughter, true), 0.015);
  EXPECT_LT(difference(beat.flows[0], readCurve(folder / "ibif_parent_Q.csv", 3), false), 0.006);
  EXPECT_LT(difference(beat.flows[1], readCurve(folder / "ibif_d1_Q.csv", 3), false), 0.006);
  // openBF loses some mass; the exact mean is that of the resistances.
  const double exact = 0.5 * inlet.mean() * (6.8123e7 + 3.1013e9);
  EXPECT_NEAR(beat.pressures[2].mean() / exact, 1.0, 0.005);
}

/** Vessel of openBF's input. */
struct InputVessel
{
  int from, to;
  double length, modulus, proximal_radius, distal_radius, profile;
  double r1, r2, compliance;  ///< zero without an outlet
};

std::vector<InputVessel> readNetwork(const std::filesystem::path& file)
{
  const yaml::Node root = yaml::readTree(file.string());
  std::vector<InputVessel> vessels;
  for (const yaml::Node& item : root.find("network")->items)
  {
    const auto number = [&item](const char* key)
    {
      const yaml::Node* value = item.find(key);
      return value == nullptr ? 0.0 : std::stod(value->text);
    };
    vessels.push_back({static_cast<int>(number("sn")), static_cast<int>(number("tn")), number("L"), number("E"),
                       number("Rp"), number("Rd"), number("gamma_profile"), number("R1"), number("R2"), number("Cc")});
  }
  return vessels;
}

/** Wall thickness of an artery of a radius, as openBF takes it where none is given [m]. */
double thickness(double radius)
{
  return radius * (0.2802 * std::exp(-505.3 * radius) + 0.1324 * std::exp(-11.14 * radius));
}

/** Adds the vessels behind a node of the input, parents first. */
void addBehind(FlowTree& tree, int input_node, int node, const std::vector<InputVessel>& vessels)
{
  for (const InputVessel& vessel : vessels)
  {
    if (vessel.from != input_node)
      continue;
    const int cells = std::max(2, static_cast<int>(std::lround(vessel.length / 5e-3)));
    const int segment = tree.cells.empty() ? 0 : tree.cells.back().segment + 1;
    int from = node;
    for (int k = 0; k < cells; ++k)
    {
      const double radius =
          vessel.proximal_radius + (vessel.distal_radius - vessel.proximal_radius) * (k + 0.5) / cells;
      FlowCell cell;
      cell.from = from;
      cell.to = from = tree.nodes++;
      cell.segment = segment;
      cell.length = vessel.length / cells;
      cell.wall = {kPi * radius * radius, 4.0 / 3.0 * vessel.modulus * thickness(radius) / radius};
      cell.profile = vessel.profile;
      tree.cells.push_back(cell);
    }
    if (vessel.r2 > 0.0)
      tree.outlets.push_back({from, vessel.r1, vessel.r2, vessel.compliance});
    addBehind(tree, vessel.to, from, vessels);
  }
}

TEST_F(Boileau, RunsTheModelOfFiftySixArteries)
{
  FlowTree tree;
  addBehind(tree, 1, 0, readNetwork(folder / "adan56.yaml"));
  ASSERT_EQ(tree.outlets.size(), 31U);
  FlowSettings settings;
  settings.reference_pressure = 1e4;
  FlowNetwork network(tree, settings, 1e4);
  const Curve inlet = readCurve(folder / "adan56_inlet.dat", 1);
  const double initial = network.totalVolume();
  const std::size_t outlet = static_cast<std::size_t>(tree.outlets[0].node);
  const Beat beat = lastBeat(network, inlet, 10, {0, outlet}, {0});
  const auto [lowest, highest] = std::minmax_element(beat.pressures[0].values.begin(), beat.pressures[0].values.end());
  EXPECT_GT(*lowest, 8e3);
  EXPECT_LT(*highest, 2e4);
  EXPECT_GT(*highest - *lowest, 3e3);
  EXPECT_LT(beat.pressures[1].mean(), beat.pressures[0].mean());
  EXPECT_NEAR(beat.flows[0].mean(), inlet.mean(), 0.02 * inlet.mean());
  EXPECT_EQ(network.supplied(), 0.0);
  EXPECT_NEAR(network.totalVolume(), initial + network.entered() - network.left(), 1e-10 * network.entered());
}

}  // namespace
}  // namespace endovascular_sim::flow
