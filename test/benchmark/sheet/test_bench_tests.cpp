#include "benchmark/sheet/bench_tests.h"

#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/sheet/data_sheet.h"
#include "scene/instrument_library.h"

namespace endovascular_sim::benchmark
{
namespace
{

instrument::Instrument library(const std::string& name)
{
  return scene::loadInstrument(scene::libraryInstrument(name));
}

void expectWithin(const BenchTest& test, std::size_t row, double tolerance)
{
  const SheetRow& found = test.rows.at(row);
  EXPECT_LT(std::abs(found.deviation()), tolerance) << test.heading << ", " << found.quantity << ": " << found.value
                                                    << " " << found.unit << ", reference " << found.reference;
}

TEST(TipFlexibilityTest, GivesTheTipLoadOfTheDataSheets)
{
  for (const char* name : {"guidewire_014_workhorse", "guidewire_014_cto"})
    expectWithin(tipFlexibilityTest(library(name)), 0, 0.01);
  EXPECT_NEAR(tipFlexibilityTest(library("guidewire_014_workhorse")).rows[0].value, 1.0, 0.05);  // gf, as its file says
}

TEST(TipLoadTest, BucklesAtTheEulerLoad)
{
  for (const char* name : {"guidewire_014_workhorse", "guidewire_014_cto", "guidewire_035_j"})
    expectWithin(tipLoadTest(library(name)), 0, 0.02);
}

TEST(TorqueTest, LagsByTheFrictionOfTheBend)
{
  const BenchTest test = torqueTest(library("guidewire_035_stiff"), {});
  expectWithin(test, 0, 0.1);
  expectWithin(test, 1, 0.5);
  expectWithin(test, 2, 0.1);
  expectWithin(test, 3, 0.1);
}

TEST(PushabilityTest, TransmitsTheForceOfStaticsInTheChannel)
{
  const BenchTest test = pushabilityTest(library("guidewire_035_stiff"), {});
  expectWithin(test, 0, 0.05);
  expectWithin(test, 1, 0.05);
}

TEST(TrackabilityTest, NeedsTheForceOfStaticsInTheChannel)
{
  const BenchTest test = trackabilityTest(library("guidewire_035_stiff"), {});
  expectWithin(test, 0, 0.1);
  expectWithin(test, 2, 0.1);
}

TEST(BenchTests, RefuseAStent)
{
  EXPECT_THROW(benchTests(library("stent_300_18"), {}), std::exception);
}

TEST(DataSheet, ListsRowsWithTheirReferences)
{
  DataSheet sheet;
  sheet.title = "a <wire>";
  BenchTest test;
  test.name = "scene";
  test.heading = "Test";
  test.rows = {{"force, at 1 mm", 1.02, "N", 1.0, "beam"},
               {"whip", 0.1, "°", 0.0, "none turns", true},
               {"free", 2.0, "N", std::nan(""), ""}};
  sheet.tests = {test};
  EXPECT_EQ(csvOf(sheet),
            "test,quantity,value,unit,reference,deviation,method\n"
            "scene,\"force, at 1 mm\",1.02,N,1,0.02,beam\n"
            "scene,whip,0.1,°,0,0.1,none turns\n"
            "scene,free,2,N,,,\n");
  const std::string html = htmlOf(sheet);
  EXPECT_NE(html.find("a &lt;wire&gt;"), std::string::npos);
  EXPECT_NE(html.find("+2.00 %"), std::string::npos);
  EXPECT_NE(html.find("+0.1 °"), std::string::npos);
  EXPECT_NE(jsonOf(sheet).find("\"reference\": null"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
