#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "benchmark/sheet/bench_session.h"
#include "benchmark/sheet/bench_tests.h"
#include "benchmark/sheet/roller_elastica.h"
#include "scene/instrument_library.h"

namespace endovascular_sim::benchmark
{
namespace
{

instrument::Instrument library(const std::string& name)
{
  return scene::loadInstrument(scene::libraryInstrument(name));
}

BenchTest testOf(const std::string& name, const std::vector<std::string>& overrides = {})
{
  return threePointTest(library(name), {}, overrides);
}

// Rows: 48 EI/L³ at a small deflection, the modulus, the exact elastica at L/10.
TEST(ThreePointTest, OfFiveWiresGivesTheStiffnessAndTheExactElasticaWithinOnePercent)
{
  for (const char* name : {"guidewire_035_straight", "guidewire_035_stiff", "guidewire_035_super_stiff",
                           "guidewire_035_lunderquist", "guidewire_014_workhorse"})
  {
    const BenchTest test = testOf(name);
    EXPECT_LT(std::abs(test.rows[0].deviation()), 0.01) << name << ": " << test.rows[0].value;
    EXPECT_LT(std::abs(test.rows[2].deviation()), 0.01) << name << ": " << test.rows[2].value;
    EXPECT_NE(test.rows[2].quantity.find("deflection of 4 mm"), std::string::npos) << test.rows[2].quantity;
  }
}

TEST(ThreePointTest, OfASoftTipGivesItsStiffness)
{
  SpecimenChoice tip;
  tip.from_tip = 0.015;
  const BenchTest test = threePointTest(library("guidewire_014_workhorse"), tip);
  EXPECT_NEAR(test.rows[0].reference, 1.6, 1e-9);
  EXPECT_LT(std::abs(test.rows[0].deviation()), 0.01);
  EXPECT_LT(std::abs(test.rows[2].deviation()), 0.01);
}

TEST(ThreePointTest, OfACatheterGivesTheModulusOfItsFile)
{
  const BenchTest test = testOf("catheter_5f_multipurpose");
  EXPECT_NEAR(test.rows[1].reference, 1.0, 1e-9);
  EXPECT_LT(std::abs(test.rows[1].deviation()), 0.01);
}

TEST(ThreePointTest, ErrorFallsWithTheSquareOfTheEdges)
{
  std::map<int, double> error;
  for (const int nodes : {25, 49, 97})
    error[nodes] = testOf("guidewire_035_straight", {"sampling.nodes=" + std::to_string(nodes)}).rows[2].deviation();
  EXPECT_LT(std::abs(error[49]), 0.4 * std::abs(error[25]));
  EXPECT_LT(std::abs(error[97]), 0.4 * std::abs(error[49]));
}

TEST(ThreePointScene, WireIsFreeAlongItself)
{
  BenchSession session("bench_three_point", {});
  session.runTo(session.scene().duration);
  const rod::State& state = session.simulation().state();
  // Both ends have moved towards the middle by the shortening, about 2.4 δ²/L of both.
  const double shortening = state.position.front().x() + 0.03;
  EXPECT_NEAR(state.position.back().x(), 0.03 - shortening, 1e-6);
  EXPECT_GT(shortening, 2e-4);
  for (const double tension : state.tension)
    EXPECT_LT(std::abs(tension), 0.5 * 3.0);  // N sin θ of the supports at most
  EXPECT_LT(state.tension.front(), 1e-3);
}

TEST(ThreePointScene, ContinuesASavedStateBitForBit)
{
  session::Session whole("bench_three_point");
  whole.step(2500);
  session::Session first("bench_three_point");
  first.step(1700);
  session::Session second("bench_three_point");
  second.load(first.save());
  second.step(800);
  EXPECT_EQ(second.simulation().trajectoryHash(), whole.simulation().trajectoryHash());
}

TEST(ThreePointScene, RollersCarryTheWeightOfAWire)
{
  session::Session session("bench_three_point",
                           {"rollers.2.displacement.points=[[0, 0]]", "loads.gravity=[0, -9.81, 0]"});
  session.step(1500);
  double up = 0.0;
  for (const Eigen::Vector3d& force : session.simulation().state().wall_force)
    up += force.y();
  const double weight = 6450.0 * M_PI * std::pow(0.5 * 0.035 * 0.0254, 2) * 0.06 * 9.81;
  EXPECT_NEAR(up, weight, 0.01 * weight);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
