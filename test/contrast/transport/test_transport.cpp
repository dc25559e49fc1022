#include "contrast/transport/transport.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/archive.h"
#include "test/contrast/transport/pipe.h"

namespace endovascular_sim::contrast
{
namespace
{

constexpr TransportSettings kWithoutDispersion{0.0, 0.45};

/** Tree of a trunk, two branches at its end and a side branch, whose walls and outlets pulsate at random. */
class PulsatingTree
{
public:
  explicit PulsatingTree(unsigned seed, const TransportSettings& settings = {})
    : transport(cells(), atRest(), settings), random_(seed)
  {
    blood.after = atRest();
    blood.before = blood.after;
  }

  static ContrastCells cells()
  {
    ContrastCells cells;
    const auto append = [&cells](int branch, int count, int parent)
    {
      for (int k = 0; k < count; ++k)
      {
        cells.push_back({branch, 2.5e-3 * k, 2.5e-3 * (k + 1), parent});
        parent = static_cast<int>(cells.size()) - 1;
      }
      return parent;
    };
    const int end = append(0, 12, -1);
    append(1, 15, end);
    append(2, 9, end);
    append(3, 6, 5);
    return cells;
  }

  static std::vector<double> atRest()
  {
    std::vector<double> volumes;
    for (const ContrastCell& cell : cells())
      volumes.push_back((cell.branch == 0 ? 40e-9 : 18e-9) * (1.0 + 10.0 * cell.begin));
    return volumes;
  }

  /** Volumes, outflows of both signs, and sometimes an injection. */
  void step()
  {
    const ContrastCells all = cells();
    const std::vector<double> rest = atRest();
    blood.before = blood.after;
    const double pressure = uniform(0.8, 1.3);
    for (std::size_t k = 0; k < all.size(); ++k)
      blood.after[k] = rest[k] * pressure * uniform(0.97, 1.03);
    blood.outflows.assign(all.size(), 0.0);
    for (const std::size_t end : {26U, 35U, 41U})
      blood.outflows[end] = uniform(-5e-9, 25e-9);
    blood.sources.clear();
    if (number_ / 100 % 3 == 0)
      blood.sources = {{8, uniform(0.0, 40e-9), 350.0}, {3, uniform(0.0, 10e-9), 200.0}};
    ++number_;
    transport.step(blood);
  }

  Transport transport;
  BloodStep blood;

private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  std::mt19937 random_;
  int number_ = 0;
};

TEST(Transport, ConservesIodineAndKeepsConcentrationsBelowTheInjectedOne)
{
  PulsatingTree tree(5);
  double reflux = 0.0, strongest = 0.0;
  for (int k = 0; k < 2000; ++k)
  {
    tree.step();
    const Transport& transport = tree.transport;
    ASSERT_LT(std::abs(transport.injected() - transport.inside() - transport.left()), 1e-10 * transport.injected())
        << k;
    double sum = 0.0;
    for (std::size_t cell = 0; cell < transport.cells(); ++cell)
    {
      ASSERT_GE(transport.mass(cell), 0.0) << k;
      ASSERT_LE(transport.mass(cell) / tree.blood.after[cell], 350.0 * (1.0 + 1e-12)) << k << ", cell " << cell;
      ASSERT_LE(transport.concentration(cell, tree.blood.after[cell]), 350.0);
      strongest = std::max(strongest, transport.concentration(cell, tree.blood.after[cell]));
      sum += transport.mass(cell);
    }
    ASSERT_NEAR(sum, transport.inside(), 1e-12 * transport.injected());
    reflux = std::min(reflux, transport.faceVolume(1));
  }
  EXPECT_GT(strongest, 300.0);
  EXPECT_LT(reflux, -5e-9) << "blood flows to the heart at times";
}

TEST(Transport, EvenFillingStaysEvenInAPulsatingTree)
{
  PulsatingTree tree(6);
  std::vector<double> masses;
  for (const double volume : tree.blood.after)
    masses.push_back(120.0 * volume);
  tree.transport.fill(masses, 120.0);
  tree.blood.inlet = 120.0;
  for (int k = 0; k < 100; ++k)
  {
    // Blood that returns through an outlet is free of iodine: none does here.
    tree.blood.before = tree.blood.after;
    for (std::size_t cell = 0; cell < masses.size(); ++cell)
      tree.blood.after[cell] = PulsatingTree::atRest()[cell] * (1.0 + 0.2 * std::sin(0.3 * k + 0.02 * cell));
    tree.blood.outflows.assign(masses.size(), 0.0);
    for (const std::size_t end : {26U, 35U, 41U})
      tree.blood.outflows[end] = 9e-9 * (1.0 + std::cos(0.3 * k));
    tree.transport.step(tree.blood);
    for (std::size_t cell = 0; cell < masses.size(); ++cell)
      ASSERT_NEAR(tree.transport.mass(cell) / tree.blood.after[cell], 120.0, 1e-10) << k << ", cell " << cell;
  }
}

/** Error of a smooth bump that has moved by half of a pipe's volume, mean of the absolute value [kg/m³].
 *  @param widening of the last cell relative to the first one; cells between change geometrically */
double errorOfABump(int count, double widening)
{
  std::vector<double> volumes;
  double whole = 0.0;
  for (int k = 0; k < count; ++k)
    whole += volumes.emplace_back(std::pow(widening, (k + 0.5) / count) / count);
  Pipe pipe(volumes, 1.0 / count, kWithoutDispersion);
  const double width = 0.15 * whole;
  const auto integral = [width](double from_centre)  // of cos⁴ over half a period each side
  {
    const double x = Pipe::kPi * std::clamp(from_centre / width, -1.0, 1.0) / 2.0;
    return 2.0 * width / Pipe::kPi * (3.0 / 8.0 * x + std::sin(2.0 * x) / 4.0 + std::sin(4.0 * x) / 32.0);
  };
  const auto massesAt = [&](double centre)
  {
    std::vector<double> masses;
    double end = 0.0;
    for (const double volume : volumes)
    {
      masses.push_back(integral(end + volume - centre) - integral(end - centre));
      end += volume;
    }
    return masses;
  };
  pipe.transport.fill(massesAt(0.25 * whole), 1.0);
  pipe.flow(0.5 * whole, count);
  const std::vector<double> exact = massesAt(0.75 * whole);
  double error = 0.0;
  for (std::size_t k = 0; k < volumes.size(); ++k)
    error += std::abs(pipe.transport.mass(k) - exact[k]) / whole;
  return error;
}

TEST(Transport, ConvergesWithSecondOrderToTheExactAdvectionOfASmoothProfile)
{
  for (const double widening : {1.0, 3.0})
  {
    const double coarse = errorOfABump(200, widening), middle = errorOfABump(400, widening);
    const double fine = errorOfABump(800, widening);
    RecordProperty("order_" + std::to_string(widening), std::to_string(std::log2(middle / fine)));
    EXPECT_GT(std::log2(coarse / middle), 1.85) << widening;
    EXPECT_GT(std::log2(middle / fine), 1.9) << widening;
    EXPECT_LT(fine, 2e-4) << widening;
  }
}

TEST(Transport, AFrontMovesWithTheBloodAndStaysSteep)
{
  constexpr int kCells = 200;
  Pipe pipe(kCells, 0.5, 2e-3, kWithoutDispersion);
  pipe.blood.inlet = 100.0;
  pipe.flow(150.0 * pipe.volumes[0], 300);
  EXPECT_NEAR(pipe.transport.inside(), 150.0 * pipe.volumes[0] * 100.0, 1e-5 * pipe.transport.inside())
      << "but for traces that are emptied";
  EXPECT_NEAR(pipe.concentration(149), 50.0, 30.0);
  EXPECT_GT(pipe.concentration(144), 95.0);
  EXPECT_LT(pipe.concentration(155), 5.0);
  for (std::size_t k = 1; k < kCells; ++k)
    EXPECT_LE(pipe.concentration(k), pipe.concentration(k - 1) + 1e-9) << "monotone, cell " << k;
}

TEST(Transport, TheVarianceOfAPlugGrowsByTwoDTimesTheTime)
{
  constexpr int kCells = 400;
  constexpr double kLength = 1.0, kRadius = 2e-3, kMoved = 0.5;
  Pipe pipe(kCells, kLength, kRadius, {});
  const double cell = kLength / kCells;
  std::vector<double> masses(kCells, 0.0);
  for (int k = 0; k < kCells; ++k)
    masses[static_cast<std::size_t>(k)] = std::exp(-0.5 * std::pow((k - 80) * cell / 0.02, 2)) * pipe.volumes[0];
  pipe.transport.fill(masses, 1.0);
  const auto moments = [&]
  {
    double sum = 0.0, mean = 0.0, square = 0.0;
    for (int k = 0; k < kCells; ++k)
    {
      const double mass = pipe.transport.mass(static_cast<std::size_t>(k)), x = (k + 0.5) * cell;
      sum += mass;
      mean += mass * x;
      square += mass * x * x;
    }
    return std::pair(mean / sum, square / sum - std::pow(mean / sum, 2));
  };
  const auto before = moments();
  pipe.flow(kMoved / cell * pipe.volumes[0], 400);
  const auto after = moments();
  EXPECT_NEAR(after.first - before.first, kMoved, 1e-4);
  const double exact = 2.0 * TransportSettings().dispersion * 2.0 * kRadius * kMoved;  // 2 D t with D = 0.3 u d
  RecordProperty("variance_relative", std::to_string((after.second - before.second) / exact));
  EXPECT_NEAR(after.second - before.second, exact, 0.02 * exact);
}

TEST(Transport, MixesByFluxesAtAJunctionAndDividesWithoutChange)
{
  // Children 1 and 2 of cell 0 receive medium that flows to the heart; then the flow turns.
  const ContrastCells cells = {{0, 0.0, 2e-3, -1}, {1, 0.0, 2e-3, 0}, {2, 0.0, 2e-3, 0}};
  const std::vector<double> volumes(3, 10e-9);
  Transport transport(cells, volumes);
  BloodStep blood{volumes, volumes, {0.0, 0.0, 0.0}, {{1, 2e-9, 300.0}, {2, 1e-9, 90.0}}, 0.0};
  for (int k = 0; k < 200; ++k)
    transport.step(blood);
  EXPECT_NEAR(transport.concentration(0, volumes[0]), 230.0, 3.0) << "with some dispersion to the children";
  EXPECT_NEAR(transport.left() + transport.inside(), transport.injected(), 1e-12 * transport.injected());
  blood.sources = {{0, 3e-9, 200.0}};
  blood.outflows = {0.0, 2e-9, 1e-9};
  for (int k = 0; k < 200; ++k)
    transport.step(blood);
  for (std::size_t cell = 0; cell < 3; ++cell)
    EXPECT_NEAR(transport.concentration(cell, volumes[cell]), 200.0, 1e-3);
}

TEST(Transport, KeepsIodineWhereNothingFlows)
{
  Pipe pipe(20, 0.05, 2e-3, {});
  std::vector<double> masses(20, 0.0);
  masses[7] = 1e-7;
  pipe.transport.fill(masses, 350.0);
  for (int k = 0; k < 100; ++k)
    pipe.transport.step(pipe.blood);
  EXPECT_EQ(pipe.transport.mass(7), 1e-7);
  EXPECT_EQ(pipe.transport.left(), 0.0);
}

TEST(Transport, CountsARestAsLeftAndThenComputesNothing)
{
  Pipe pipe(40, 0.1, 2e-3, {});
  pipe.blood.sources = {{3, 0.2 * pipe.volumes[0], 350.0}};
  pipe.flow(0.5 * pipe.volumes[0], 1);
  pipe.blood.sources.clear();
  for (int k = 0; k < 1000 && !pipe.transport.isEmpty(); ++k)
    pipe.transport.step(pipe.blood);
  ASSERT_TRUE(pipe.transport.isEmpty());
  EXPECT_NEAR(pipe.transport.left(), pipe.transport.injected(), 1e-12 * pipe.transport.injected());
  const std::uint64_t substeps = pipe.transport.substeps();
  pipe.transport.step(pipe.blood);
  EXPECT_EQ(pipe.transport.substeps(), substeps);
}

TEST(Transport, TakesSubstepsOnlyForCellsThatIodineReaches)
{
  // A narrow cell far from the iodine would need many substeps.
  std::vector<double> volumes(100, 10e-9);
  volumes[90] = 1e-10;
  Pipe pipe(volumes, 2.5e-3, {});
  pipe.blood.sources = {{5, 1e-9, 350.0}};
  pipe.flow(4e-9, 1);
  EXPECT_EQ(pipe.transport.substeps(), 1U);
}

TEST(Transport, ContinuesFromAnArchiveWithEqualBits)
{
  PulsatingTree first(9), second(9);
  for (int k = 0; k < 250; ++k)
  {
    first.step();
    second.step();
  }
  Archive written;
  first.transport.archive(written);
  Archive read(written.bytes());
  second.transport = Transport(PulsatingTree::cells(), PulsatingTree::atRest());
  second.transport.archive(read);
  for (int k = 0; k < 250; ++k)
  {
    first.step();
    second.step();
    for (std::size_t cell = 0; cell < first.transport.cells(); ++cell)
      ASSERT_EQ(first.transport.mass(cell), second.transport.mass(cell)) << k;
    ASSERT_EQ(first.transport.left(), second.transport.left());
  }
}

TEST(Transport, RefusesAnArchiveOfAnotherVessel)
{
  PulsatingTree tree(2);
  tree.step();
  Archive written;
  tree.transport.archive(written);
  Archive read(written.bytes());
  Pipe pipe(4, 0.01, 2e-3, {});
  EXPECT_THROW(pipe.transport.archive(read), ArchiveError);
}

TEST(Transport, RefusesCellsWithoutVolumeAndStepsOfOtherCells)
{
  const ContrastCells cells = Pipe::cellsOf(3, 2e-3);
  EXPECT_THROW(Transport(cells, {1e-9, 0.0, 1e-9}), std::invalid_argument);
  EXPECT_THROW(Transport(cells, {1e-9, std::nan(""), 1e-9}), std::invalid_argument);
  EXPECT_THROW(Transport(cells, {1e-9, 1e-9}), std::invalid_argument);
  Pipe pipe(3, 6e-3, 2e-3, {});
  pipe.blood.outflows.pop_back();
  EXPECT_THROW(pipe.transport.step(pipe.blood), std::invalid_argument);
  pipe.blood.outflows.push_back(0.0);
  pipe.blood.sources = {{3, 1e-9, 350.0}};
  EXPECT_THROW(pipe.transport.step(pipe.blood), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::contrast
