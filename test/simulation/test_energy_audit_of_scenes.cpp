#include <cmath>

#include <gtest/gtest.h>

#include "rod/energy/energy_audit.h"
#include "session/session.h"

// The energy audit of shipped scenes.

namespace endovascular_sim::simulation
{
namespace
{

/** Simulates the tube until its wire is in the bend. @param audit may be null */
std::uint64_t runTube(rod::EnergyAudit* audit)
{
  session::Session session("tube", {"drive.speed=0.1", "drive.initial_insertion=0.04", "duration=0.5"});
  session.simulation().setObserver(audit);
  while (!session.isOver())
    session.step();
  return session.simulation().trajectoryHash();
}

}  // namespace

TEST(EnergyAuditOfScenes, ClosesInATubeAndLeavesTheTrajectoryUnchanged)
{
  rod::EnergyAudit audit;
  EXPECT_EQ(runTube(&audit), runTube(nullptr));
  const rod::EnergyBalance& balance = audit.balance();
  EXPECT_GT(balance.push, 1e-3);
  EXPECT_GT(balance.bending, 0.3 * balance.push);
  EXPECT_GT(balance.wall_friction, 0.05 * balance.push);
  EXPECT_NEAR(balance.error(), 0.0, 0.01 * balance.turnover);
}

TEST(EnergyAuditOfScenes, ClosesInFlowingBloodWhoseWorkIsAnItem)
{
  session::Session session("catheter", {"duration=3", "flow=adult", "flow.drag=all"});
  rod::EnergyAudit audit;
  session.simulation().setObserver(&audit);
  while (!session.isOver())
    session.step();
  const rod::EnergyBalance& balance = audit.balance();
  EXPECT_GT(std::abs(balance.stream), 1e-6);
  EXPECT_NEAR(balance.error(), 0.0, 0.01 * balance.turnover);
}

TEST(EnergyAuditOfScenes, ClosesForACatheterOverAWireWithAdaptiveNodes)
{
  session::Session session("catheter", {"duration=3"});
  rod::EnergyAudit audit;
  session.simulation().setObserver(&audit);
  while (!session.isOver())
    session.step();
  EXPECT_GT(audit.balance().push, 1e-3);
  EXPECT_NEAR(audit.balance().error(), 0.0, 0.03 * audit.balance().turnover);
}

TEST(EnergyAuditOfScenes, SchemesWithoutAnAuditRefuseIt)
{
  session::Session session("straight_wire", {"solver.scheme=mixed"});
  rod::EnergyAudit audit;
  EXPECT_THROW(session.simulation().setObserver(&audit), std::logic_error);
}

}  // namespace endovascular_sim::simulation
