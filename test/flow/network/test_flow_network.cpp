#include "flow/network/flow_network.h"

#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "test/flow/network/flow_fixtures.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
using Complex = std::complex<double>;

TEST(FlowNetwork, HasThePressureDropOfPoiseuille)
{
  const UniformVessel pipe{0.1, 2e-3, 300.0, 2.0, 1.0};
  FlowSettings settings;
  FlowTree tree;
  const int end = append(tree, 0, pipe, 20, settings.density);
  tree.outlets.push_back({end, 1e8, 1e9, 1e-12});
  FlowNetwork network(tree, settings, 0.0);
  constexpr double kFlow = 5e-6;
  for (int k = 0; k < 20000; ++k)
    network.step(kFlow, {0.0});
  double expected = 0.0;
  for (std::size_t k = 0; k < tree.cells.size(); ++k)
    expected += 8.0 * kPi * settings.viscosity * tree.cells[k].length * kFlow / std::pow(network.area(k), 2);
  const double drop = network.pressure(0) - network.pressure(static_cast<std::size_t>(end));
  EXPECT_NEAR(drop / expected, 1.0, 1e-5);
  EXPECT_NEAR(network.flow(10), kFlow, 1e-6 * kFlow);
}

/** Pulse in a parent with two equal daughters, without friction. */
struct Bifurcation
{
  /** @param area_ratio of both daughters to the parent */
  Bifurcation(double area_ratio, double time_step)
  {
    settings.time_step = time_step;
    settings.viscosity = 0.0;
    const UniformVessel parent{kLength, 6e-3, kSpeed, 2.0, 1.0};
    const UniformVessel daughter{kLength, 6e-3 * std::sqrt(area_ratio / 2.0), kSpeed, 2.0, 1.0};
    const int cells = static_cast<int>(std::lround(kLength / 0.002));
    FlowTree tree;
    const int junction = append(tree, 0, parent, cells, settings.density);
    for (int k = 0; k < 2; ++k)
      tree.outlets.push_back({append(tree, junction, daughter, cells, settings.density),
                              impedanceOf(daughter, settings.density), 1e15, 1e-3});
    FlowNetwork network(tree, settings, 0.0);
    const std::size_t middle = static_cast<std::size_t>(cells / 2);
    for (int k = 1; k <= static_cast<int>(0.225 / time_step); ++k)
    {
      const double t = k * time_step;
      network.step(1e-8 * std::exp(-0.5 * std::pow((t - kPeak) / kWidth, 2)), {0.0, 0.0});
      const double pressure = network.pressure(middle);
      if (t < kPeak + 0.5 * kLength / kSpeed + 5.0 * kWidth && pressure > incident)
      {
        incident = pressure;
        arrival = t;
      }
      if (t > kPeak + 0.5 * kLength / kSpeed + 7.0 * kWidth && std::abs(pressure) > std::abs(reflected))
        reflected = pressure;
    }
    const double own = 1.0 / impedanceOf(parent, settings.density);
    const double daughters = 2.0 / impedanceOf(daughter, settings.density);
    exact = (own - daughters) / (own + daughters);
  }

  static constexpr double kLength = 0.6, kSpeed = 6.0, kPeak = 0.04, kWidth = 0.008;
  FlowSettings settings;
  double incident = 0.0, reflected = 0.0, arrival = 0.0, exact = 0.0;
};

TEST(FlowNetwork, CarriesAPulseWithTheWaveSpeed)
{
  const Bifurcation pulse(1.0, 1e-4);
  const double speed = 0.5 * Bifurcation::kLength / (pulse.arrival - Bifurcation::kPeak);
  EXPECT_NEAR(speed, Bifurcation::kSpeed, 0.01 * Bifurcation::kSpeed);
  const Bifurcation coarse(1.0, 1e-3);
  const double of_coarse = 0.5 * Bifurcation::kLength / (coarse.arrival - Bifurcation::kPeak);
  EXPECT_NEAR(of_coarse, Bifurcation::kSpeed, 0.02 * Bifurcation::kSpeed) << "the time of a peak has the step of 1 ms";
}

TEST(FlowNetwork, ReflectsAPulseAtABifurcation)
{
  for (const double ratio : {0.8, 1.15, 2.0})
  {
    const Bifurcation coarse(ratio, 1e-3), fine(ratio, 1e-4);
    RecordProperty("reflection_" + std::to_string(ratio), std::to_string(coarse.reflected / coarse.incident));
    EXPECT_NEAR(coarse.reflected / coarse.incident, coarse.exact, 0.10 * std::abs(coarse.exact)) << ratio;
    EXPECT_NEAR(fine.reflected / fine.incident, fine.exact, 0.01 * std::abs(fine.exact)) << ratio;
  }
}

/** Bessel function of the first kind by its series. */
Complex bessel(int order, Complex z)
{
  Complex term = 1.0;
  for (int q = 1; q <= order; ++q)
    term *= z / 2.0 / static_cast<double>(q);
  Complex sum = term;
  for (int k = 1; k < 80; ++k)
  {
    term *= -z * z / 4.0 / static_cast<double>(k * (k + order));
    sum += term;
  }
  return sum;
}

/** Longitudinal impedance of a rigid pipe per length, Womersley 1955 [Pa·s/m⁴]. */
Complex womersley(double radius, double frequency, const FlowSettings& blood)
{
  const double omega = 2.0 * kPi * frequency;
  const double alpha = radius * std::sqrt(omega * blood.density / blood.viscosity);
  const Complex i(0.0, 1.0), z = alpha * std::pow(i, 1.5);
  const Complex profile = 2.0 * bessel(1, z) / (z * bessel(0, z));
  return i * omega * blood.density / (kPi * radius * radius) / (1.0 - profile);
}

TEST(FlowNetwork, HasTheImpedanceOfWomersley)
{
  for (const auto& [frequency, bound] : {std::pair(1.0, 0.02), std::pair(5.0, 0.08)})
  {
    const UniformVessel pipe{0.02, 2e-3, 200.0, 2.0, 4.0 / 3.0};
    FlowSettings settings;
    settings.time_step = 1e-4;
    FlowTree tree;
    const int end = append(tree, 0, pipe, 10, settings.density);
    tree.outlets.push_back({end, 1e6, 1e4, 1e-3});
    FlowNetwork network(tree, settings, 0.0);
    const double omega = 2.0 * kPi * frequency;
    const int period = static_cast<int>(std::lround(1.0 / frequency / settings.time_step));
    Complex drop = 0.0, flow = 0.0;
    for (int k = 1; k <= 4 * period; ++k)
    {
      const double t = k * settings.time_step;
      network.step(1e-7 * std::sin(omega * t), {0.0});
      if (k <= 3 * period)
        continue;
      const Complex wave = std::exp(Complex(0.0, -omega * t));
      drop += (network.pressure(2) - network.pressure(8)) * wave;
      flow += 0.5 * (network.flow(4) + network.flow(5)) * wave;
    }
    const Complex exact = womersley(pipe.radius, frequency, settings);
    const Complex found = drop / flow / (0.6 * pipe.length);
    EXPECT_NEAR(std::abs(found) / std::abs(exact), 1.0, bound) << frequency << " Hz";
  }
}

/** Body of four branches with windkessels. */
FlowTree body(const FlowSettings& settings)
{
  FlowTree tree;
  const int first = append(tree, 0, {0.1, 12e-3, 5.0, 9.0, 1.0}, 12, settings.density);
  const int second = append(tree, first, {0.2, 9e-3, 6.0, 9.0, 1.0}, 25, settings.density);
  tree.outlets.push_back(
      {append(tree, first, {0.15, 4e-3, 8.0, 2.0, 4.0 / 3.0}, 20, settings.density), 8e7, 8e8, 2e-9});
  tree.outlets.push_back(
      {append(tree, second, {0.1, 1.5e-3, 9.0, 2.0, 4.0 / 3.0}, 50, settings.density), 5e8, 5e9, 1e-10});
  tree.outlets.push_back({append(tree, second, {0.2, 5e-3, 8.0, 2.0, 1.0}, 25, settings.density), 2e7, 1.5e8, 9e-9});
  return tree;
}

double beat(double t)
{
  const double s = std::fmod(t, 0.85);
  return s < 0.3 ? 4.4e-4 * std::sin(kPi * s / 0.3) : 0.0;
}

TEST(FlowNetwork, ConservesBlood)
{
  FlowSettings settings;
  settings.reference_pressure = 1e4;
  FlowNetwork network(body(settings), settings, 1e4);
  const double initial = network.totalVolume();
  for (int k = 1; k <= 8500; ++k)
    network.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  const double stroke = network.entered() / 10.0;
  EXPECT_NEAR(stroke, 4.4e-4 * 0.3 * 2.0 / kPi, 1e-3 * stroke);
  EXPECT_EQ(network.supplied(), 0.0);
  EXPECT_LT(std::abs(initial + network.entered() - network.left() - network.totalVolume()), 1e-10 * stroke);
}

TEST(FlowNetwork, ConservesBloodWithASource)
{
  FlowSettings settings;
  settings.reference_pressure = 1e4;
  FlowNetwork network(body(settings), settings, 1e4);
  const double initial = network.totalVolume();
  constexpr double kSource = 6e-6;  // [m³/s]
  for (int k = 1; k <= 8500; ++k)
  {
    network.setSource(40, k > 2000 && k <= 5000 ? kSource : 0.0);
    network.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  }
  EXPECT_NEAR(network.injected(), 3.0 * kSource, 1e-12 * kSource);
  EXPECT_LT(std::abs(initial + network.entered() + network.injected() - network.left() - network.totalVolume()),
            1e-10 * network.entered());
}

TEST(FlowNetwork, ASourceFlowsToBothSidesOfItsNode)
{
  FlowSettings settings;
  FlowTree tree;
  const int end = append(tree, 0, {0.1, 2e-3, 50.0, 2.0, 1.0}, 20, settings.density);
  tree.outlets.push_back({end, 1e8, 1e9, 1e-12});
  FlowNetwork network(tree, settings, 0.0);
  constexpr double kFlow = 2e-6, kSource = 5e-6;
  network.setSource(10, kSource);
  for (int k = 0; k < 20000; ++k)
    network.step(kFlow - kSource, {0.0});  // with reflux, as the pump has the larger flow
  EXPECT_NEAR(network.flow(5), kFlow - kSource, 1e-6 * kFlow);
  EXPECT_NEAR(network.flow(15), kFlow, 1e-6 * kFlow);
  EXPECT_NEAR(network.outflow(0), kFlow, 1e-6 * kFlow);
}

TEST(FlowNetwork, ThePressureDropFollowsTheViscosityOfACell)
{
  FlowSettings settings;
  FlowTree tree;
  const int end = append(tree, 0, {0.1, 2e-3, 300.0, 2.0, 1.0}, 20, settings.density);
  tree.outlets.push_back({end, 1e8, 1e9, 1e-12});
  FlowNetwork network(tree, settings, 0.0);
  constexpr double kFlow = 5e-6;
  const auto drop = [&]
  {
    for (int k = 0; k < 20000; ++k)
      network.step(kFlow, {0.0});
    return network.pressure(10) - network.pressure(11);
  };
  const double of_blood = drop();
  network.setViscosityFactor(10, 2.6);
  EXPECT_NEAR(drop() / of_blood, 2.6, 1e-4);
  network.setViscosityFactor(10, 1.0);
  EXPECT_NEAR(drop() / of_blood, 1.0, 1e-4);
}

TEST(FlowNetwork, HasTheBitsOfBloodAloneWithoutSourcesAndWithItsOwnViscosity)
{
  FlowSettings settings;
  settings.reference_pressure = 1e4;
  FlowNetwork plain(body(settings), settings, 1e4), with(body(settings), settings, 1e4);
  with.setObstacle(30, {0.0, 3e8, 1e13});
  plain.setObstacle(30, {0.0, 3e8, 1e13});
  with.setSource(7, 1e-6);
  with.setSource(7, 0.0);
  for (int k = 1; k <= 1000; ++k)
  {
    for (std::size_t cell = 0; cell < with.tree().cells.size(); ++cell)
      with.setViscosityFactor(cell, 1.0);
    plain.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
    with.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  }
  Archive of_plain, of_with;
  plain.archive(of_plain);
  with.archive(of_with);
  EXPECT_EQ(of_plain.bytes(), of_with.bytes());
}

TEST(FlowNetwork, RefusesSourcesAndViscositiesThatAreNotPossible)
{
  FlowSettings settings;
  FlowNetwork network(body(settings), settings, 1e4);
  EXPECT_THROW(network.setSource(1000, 1e-6), std::invalid_argument);
  EXPECT_THROW(network.setSource(1, std::nan("")), std::invalid_argument);
  EXPECT_THROW(network.setViscosityFactor(1, 0.0), std::invalid_argument);
  EXPECT_THROW(network.setViscosityFactor(1, std::nan("")), std::invalid_argument);
}

TEST(FlowNetwork, GivesTheSamePressuresForEveryTimeStep)
{
  double reference = 0.0;
  for (const double step : {2.5e-4, 1e-3, 5e-3, 1e-2})
  {
    FlowSettings settings;
    settings.reference_pressure = 1e4;
    settings.time_step = step;
    FlowNetwork network(body(settings), settings, 1e4);
    const int steps = static_cast<int>(std::lround(0.85 / step));
    double mean = 0.0;
    for (int k = 1; k <= 12 * steps; ++k)
    {
      network.step(beat(k * step), {500.0, 500.0, 500.0});
      if (k > 11 * steps)
        mean += network.pressure(network.tree().cells[40].to) / steps;
    }
    if (reference == 0.0)
      reference = mean;
    EXPECT_NEAR(mean, reference, 0.004 * reference) << step << " s";
  }
}

TEST(FlowNetwork, ConvergesToTheSolutionOfASmallTimeStepWithOrderOne)
{
  const auto pressureAfter = [](double step)
  {
    FlowSettings settings;
    settings.reference_pressure = 1e4;
    settings.time_step = step;
    FlowNetwork network(body(settings), settings, 1e4);
    for (int k = 1; k <= static_cast<int>(std::lround(0.2 / step)); ++k)
      network.step(beat(k * step), {500.0, 500.0, 500.0});
    return network.pressure(20);
  };
  const double exact = pressureAfter(1.25e-5);
  const double coarse = std::abs(pressureAfter(4e-4) - exact), fine = std::abs(pressureAfter(1e-4) - exact);
  EXPECT_GT(std::log(coarse / fine) / std::log(4.0), 0.8);
  EXPECT_LT(coarse, 20.0);
}

TEST(FlowNetwork, ALossReducesTheFlowAsItsFormula)
{
  FlowSettings settings;
  FlowTree tree;
  const int end = append(tree, 0, {0.05, 1.5e-3, 50.0, 2.0, 1.0}, 10, settings.density);
  tree.outlets.push_back({end, 1e8, 1e9, 1e-12});
  FlowNetwork network(tree, settings, 0.0);
  constexpr double kFlow = 3e-6;
  const auto drop = [&]
  {
    for (int k = 0; k < 4000; ++k)
      network.step(kFlow, {0.0});
    return network.pressure(4) - network.pressure(5);
  };
  const double free = drop();
  network.setObstacle(4, {0.0, 2e8, 0.0});
  EXPECT_NEAR(drop() - free, 2e8 * kFlow, 1e-3 * 2e8 * kFlow);
  network.setObstacle(4, {0.0, 0.0, 1e14});
  EXPECT_NEAR(drop() - free, 1e14 * kFlow * kFlow, 1e-3 * 1e14 * kFlow * kFlow);
}

TEST(FlowNetwork, AClosedCellHasNoFlow)
{
  FlowSettings settings;
  settings.reference_pressure = 1e4;
  FlowNetwork network(body(settings), settings, 1e4);
  const std::size_t closed = 40;  // in the first branch
  FlowObstacle balloon;
  balloon.blocked = 1.0;
  network.setObstacle(closed, balloon);
  for (int k = 1; k <= 20000; ++k)
    network.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  EXPECT_EQ(network.flow(closed), 0.0);
  EXPECT_NEAR(network.outflow(0), 0.0, 1e-9) << "the vessel behind it has drained";
  EXPECT_LT(network.pressure(static_cast<std::size_t>(network.tree().outlets[0].node)), 600.0);
  network.setObstacle(closed, {});
  for (int k = 1; k <= 10 * 850; ++k)
    network.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  EXPECT_GT(network.outflow(0), 1e-6);
}

TEST(FlowNetwork, HasPositiveAreasAndFiniteValuesInAllExtremes)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const double step : {1e-3, 5e-3})
  {
    FlowSettings settings;
    settings.reference_pressure = 1e4;
    settings.time_step = step;
    FlowNetwork network(body(settings), settings, 1e4);
    const double initial = network.totalVolume();
    double period = 0.85;
    for (int k = 1; k <= 60000; ++k)
    {
      if (k % 500 == 0)
      {
        for (std::size_t cell = 0; cell < network.tree().cells.size(); ++cell)
          network.setObstacle(cell, {});
        FlowObstacle obstacle;
        obstacle.blocked = unit(random) < 0.5 ? 1.0 : 0.0;
        obstacle.loss = 1e16 * unit(random);
        network.setObstacle(static_cast<std::size_t>(unit(random) * 130.0), obstacle);
        const double rates[] = {30.0, 70.0, 220.0};
        period = 60.0 / rates[static_cast<std::size_t>(3.0 * unit(random))];
      }
      const bool is_arrest = k % 20000 > 15000;
      const double flow = is_arrest ? 0.0 : beat(std::fmod(k * step, period) * 0.85 / period);
      const double muscle = 16000.0 * (std::fmod(k * step, period) < 0.35 * period ? 1.0 : 0.0);
      network.step(flow, {500.0, muscle, 500.0});
      for (std::size_t cell = 0; cell < network.tree().cells.size(); ++cell)
      {
        ASSERT_TRUE(std::isfinite(network.flow(cell))) << k;
        ASSERT_GT(network.area(cell), 0.0) << k;
      }
      for (std::size_t node = 0; node < static_cast<std::size_t>(network.tree().nodes); ++node)
        ASSERT_GT(network.volume(node), 0.0) << k;
    }
    EXPECT_LT(std::abs(initial + network.entered() + network.supplied() - network.left() - network.totalVolume()),
              1e-9 * network.entered());
    EXPECT_LT(network.supplied(), 2e-2 * network.entered());
  }
}

TEST(FlowNetwork, ContinuesFromAnArchiveWithEqualBits)
{
  FlowSettings settings;
  settings.reference_pressure = 1e4;
  FlowNetwork first(body(settings), settings, 1e4), second(body(settings), settings, 0.0);
  for (int k = 1; k <= 500; ++k)
    first.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  Archive written;
  first.archive(written);
  Archive read(written.bytes());
  second.archive(read);
  for (int k = 501; k <= 900; ++k)
  {
    first.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
    second.step(beat(k * 1e-3), {500.0, 500.0, 500.0});
  }
  for (std::size_t node = 0; node < static_cast<std::size_t>(first.tree().nodes); ++node)
    EXPECT_EQ(first.pressure(node), second.pressure(node));
}

TEST(FlowNetwork, RefusesWhatIsNoTree)
{
  FlowSettings settings;
  FlowTree loop = body(settings);
  loop.cells.back().from = loop.cells.back().to;
  EXPECT_THROW(FlowNetwork(loop, settings, 0.0), std::invalid_argument);
  FlowTree twice = body(settings);
  twice.cells.push_back(twice.cells.back());
  EXPECT_THROW(FlowNetwork(twice, settings, 0.0), std::invalid_argument);
  FlowTree negative = body(settings);
  negative.outlets[0].compliance = -1e-10;
  EXPECT_THROW(FlowNetwork(negative, settings, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::flow
