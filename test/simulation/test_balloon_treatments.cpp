#include "simulation/balloon_treatments.h"

#include <gtest/gtest.h>

#include "test/simulation/treatment_bench.h"

namespace endovascular_sim::simulation
{
namespace
{

TEST(BalloonTreatments, ABalloonThatFillsItsLesionStaysWithinTheLimitOfSolves)
{
  TreatmentBench bench({"drive.force_limit=50"});
  bench.runTo(0.3);
  int solves = 0;
  int factorisations = 0;
  int hit_iteration_limit = 0;
  while (bench.simulation.time() < 0.6)
  {
    bench.runTo(bench.simulation.time() + 1e-3);
    solves += bench.simulation.report().solves;
    factorisations += bench.simulation.report().factorisations;
    hit_iteration_limit += bench.simulation.report().hit_iteration_limit;
  }
  EXPECT_GT(solves, 300);  // the balloon presses the wall
  EXPECT_LT(factorisations, 800);
  EXPECT_LT(hit_iteration_limit, 6);  // of 300 steps
  EXPECT_EQ(bench.rejected, 0);
}

TEST(BalloonTreatments, OpenTheLesionAndLeaveTheStentInIt)
{
  TreatmentBench bench({"drive.force_limit=50"});  // while the balloon opens it pulls with up to 13 N
  EXPECT_NEAR(bench.narrowest(), 0.8e-3, 0.05e-3);
  bench.runTo(2.0);
  EXPECT_GT(bench.narrowest(), 1.4e-3);
  EXPECT_FALSE(bench.happened(TreatmentEvent::kStentPlaced));
  bench.runTo(6.0);
  EXPECT_EQ(bench.rejected, 0);
  EXPECT_LT(bench.deepest, 0.1e-3);
  EXPECT_TRUE(bench.happened(TreatmentEvent::kStentPlaced));
  EXPECT_FALSE(bench.happened(TreatmentEvent::kBurst));
  EXPECT_FALSE(bench.happened(TreatmentEvent::kStentLost));
  EXPECT_NEAR(bench.narrowest(), 1.45e-3, 0.1e-3) << "held open";
  EXPECT_NEAR(bench.simulation.hand(0).insertion, 0.015, 1e-6) << "the catheter has left the stent";
  const intervention::StentPlacement& stent = *bench.simulation.treatment(0)->stent();
  EXPECT_EQ(stent.state(), intervention::StentPlacement::State::kPlaced);
  EXPECT_NEAR(stent.sleeve().axis[stent.sleeve().axis.size() / 2].z(), 0.030, 0.5e-3);
}

TEST(BalloonTreatments, ReportABurstBalloonAndAStentLostOutside)
{
  TreatmentBench burst({"drive.pressure.points=[[0, 0], [0.2, 3.0e6]]"});
  burst.runTo(1.5);
  EXPECT_TRUE(burst.happened(TreatmentEvent::kAboveRated));
  EXPECT_TRUE(burst.happened(TreatmentEvent::kBurst));
  EXPECT_EQ(burst.simulation.treatment(0)->inflation().pressure(), 0.0);
  TreatmentBench outside({"drive.initial_insertion=0.001", "drive.insertion.points=[[0, 0]]"});
  outside.runTo(1.0);
  EXPECT_TRUE(outside.happened(TreatmentEvent::kStentLost));
  EXPECT_EQ(outside.wall.version(), 1U) << "no balloon load from outside";
}

}  // namespace
}  // namespace endovascular_sim::simulation
