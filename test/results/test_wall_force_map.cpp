#include "results/wall_force_map.h"
#include "scene/scene_file.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "contact/detector.h"
#include "results/wall_force_report.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::results
{
namespace
{

constexpr double kStep = 1e-3;

/** Strip of triangles along x. The first half belongs to the branch "near", the second half to "far". */
vessel::Vessel strip(int triangles)
{
  vessel::Vessel vessel;
  for (int k = 0; k < triangles + 2; ++k)
    vessel.mesh.vertices.emplace_back(1e-3 * k, k % 2 == 0 ? 0.0 : 1e-3, 0.0);
  for (int k = 0; k < triangles; ++k)
    vessel.mesh.triangles.emplace_back(k, k + 1, k + 2);
  vessel.centreline.branches.resize(2);
  const double middle = 0.5e-3 * (triangles + 1);
  vessel.centreline.branches[0].name = "near";
  vessel.centreline.branches[0].points = {{0.0, 0.0, 2e-3}, {middle - 1e-4, 0.0, 2e-3}};
  vessel.centreline.branches[1].name = "far";
  vessel.centreline.branches[1].points = {{middle + 1e-4, 0.0, 2e-3}, {2.0 * middle, 0.0, 2e-3}};
  for (vessel::CentrelineBranch& branch : vessel.centreline.branches)
    branch.radii = {2e-3, 2e-3};
  return vessel;
}

simulation::WallContact contactOf(int triangle, double force, const Eigen::Vector3d& position = Eigen::Vector3d::Zero())
{
  simulation::WallContact contact;
  contact.triangle = triangle;
  contact.normal_force = force * Eigen::Vector3d(0.6, 0.0, 0.8);
  contact.resting_force = contact.normal_force;
  contact.friction_force = Eigen::Vector3d(0.0, 100.0, 0.0);  // must have no effect
  contact.position = position;
  return contact;
}

TEST(WallForceMap, ComputesPeakIntegralAndTimeOverThresholdOfAKnownSequence)
{
  WallForceMap map(0.1, strip(10));
  map.add({contactOf(0, 0.05), contactOf(9, 0.2, {1.0, 2.0, 3.0})}, 1e-3, kStep);
  map.add({contactOf(0, 0.15), contactOf(0, 0.12)}, 2e-3, kStep);  // two nodes on one triangle
  map.add({}, 3e-3, kStep);
  map.add({contactOf(0, 0.1)}, 4e-3, kStep);  // equal to the threshold, not above it

  ASSERT_EQ(map.touched().size(), 2U);
  const WallForce& first = map.touched()[0];
  EXPECT_EQ(first.triangle, 0);
  EXPECT_NEAR(first.peak, 0.15, 1e-15);
  EXPECT_EQ(first.peak_time, 2e-3);
  EXPECT_NEAR(first.integral, (0.05 + 0.27 + 0.1) * kStep, 1e-15);
  EXPECT_NEAR(first.time_over_threshold, kStep, 1e-15);
  EXPECT_NEAR(map.touched()[1].time_over_threshold, kStep, 1e-15);

  const WallForceSummary summary = map.summary();
  EXPECT_EQ(summary.threshold, 0.1);
  EXPECT_EQ(summary.time, 4e-3);
  EXPECT_NEAR(summary.whole.peak, 0.2, 1e-15);
  EXPECT_EQ(summary.whole.peak_position, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(summary.whole.peak_time, 1e-3);
  EXPECT_EQ(summary.whole.peak_region, 1);
  EXPECT_NEAR(summary.whole.peak_sum, 0.27, 1e-15);
  EXPECT_EQ(summary.whole.peak_sum_time, 2e-3);
  EXPECT_NEAR(summary.whole.integral, 0.62 * kStep, 1e-15);
  EXPECT_NEAR(summary.whole.time_over_threshold, 2 * kStep, 1e-15);

  ASSERT_EQ(summary.regions.size(), 2U);
  EXPECT_EQ(summary.regions[0].name, "near");
  EXPECT_NEAR(summary.regions[0].peak, 0.15, 1e-15);
  EXPECT_NEAR(summary.regions[0].peak_sum, 0.27, 1e-15);
  EXPECT_EQ(summary.regions[1].name, "far");
  EXPECT_NEAR(summary.regions[1].integral, 0.2 * kStep, 1e-15);
  EXPECT_NEAR(summary.regions[1].time_over_threshold, kStep, 1e-15);
}

TEST(WallForceMap, EqualsADenseMapOfAllTrianglesAndSteps)
{
  constexpr int kTriangles = 60;
  constexpr int kSteps = 400;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> triangle(0, kTriangles - 1);
  std::uniform_int_distribution<int> count(0, 12);
  std::exponential_distribution<double> force(20.0);
  const vessel::Vessel vessel = strip(kTriangles);
  WallForceMap map(0.1, vessel);
  std::vector<std::vector<std::vector<double>>> dense(kSteps, std::vector<std::vector<double>>(kTriangles));
  for (int step = 0; step < kSteps; ++step)
  {
    std::vector<simulation::WallContact> contacts(static_cast<std::size_t>(count(random)));
    for (simulation::WallContact& contact : contacts)
    {
      contact = contactOf(triangle(random), force(random));
      dense[step][contact.triangle].push_back(contact.normal_force.norm());
    }
    map.add(contacts, (step + 1) * kStep, kStep);
  }
  for (const WallForce& record : map.touched())
  {
    double peak = 0.0, integral = 0.0, over = 0.0;
    for (int step = 0; step < kSteps; ++step)
    {
      bool is_over = false;
      for (const double f : dense[step][record.triangle])
      {
        peak = std::max(peak, f);
        integral += f * kStep;
        is_over = is_over || f > 0.1;
      }
      over += is_over ? kStep : 0.0;
    }
    EXPECT_EQ(record.peak, peak) << record.triangle;
    EXPECT_NEAR(record.integral, integral, 1e-14) << record.triangle;
    EXPECT_NEAR(record.time_over_threshold, over, 1e-12) << record.triangle;
    EXPECT_EQ(record.region, map.centre(record.triangle).x() < 0.5e-3 * (kTriangles + 1) ? 0 : 1) << record.triangle;
  }
  double peak_sum = 0.0, integral = 0.0, over = 0.0;
  for (const auto& triangles : dense)
  {
    double sum = 0.0, largest = 0.0;
    for (const auto& forces : triangles)
      for (const double f : forces)
      {
        sum += f;
        largest = std::max(largest, f);
      }
    peak_sum = std::max(peak_sum, sum);
    integral += sum * kStep;
    over += largest > 0.1 ? kStep : 0.0;
  }
  const WallForceTotals whole = map.summary().whole;
  EXPECT_NEAR(whole.peak_sum, peak_sum, 1e-12);
  EXPECT_NEAR(whole.integral, integral, 1e-12);
  EXPECT_NEAR(whole.time_over_threshold, over, 1e-12);
}

TEST(WallForceMap, CountsAContactWithoutATriangleInTheTotalsOnly)
{
  WallForceMap map(0.1, strip(10));
  map.add({contactOf(-1, 0.3, {0.0, 0.0, 0.0}), contactOf(10, 0.3, {10e-3, 0.0, 0.0})}, kStep, kStep);
  EXPECT_TRUE(map.touched().empty());
  EXPECT_NEAR(map.summary().whole.peak_sum, 0.6, 1e-15);
  ASSERT_EQ(map.summary().regions.size(), 2U);
  EXPECT_EQ(map.summary().regions[0].name, "near");
  EXPECT_EQ(map.summary().regions[1].name, "far");
}

TEST(WallForceMap, IgnoresNonFiniteForces)
{
  WallForceMap map(0.1, strip(10));
  map.add({contactOf(1, std::nan("")), contactOf(2, std::numeric_limits<double>::infinity()), contactOf(3, 0.0)}, kStep,
          kStep);
  EXPECT_TRUE(map.touched().empty());
  EXPECT_EQ(map.summary().whole.integral, 0.0);
  EXPECT_TRUE(map.summary().regions.empty());
}

TEST(WallForceMap, WorksWithoutACentreline)
{
  vessel::Vessel vessel = strip(4);
  vessel.centreline.branches.clear();
  WallForceMap map(0.0, vessel);
  map.add({contactOf(2, 0.3)}, kStep, kStep);
  EXPECT_EQ(map.touched()[0].region, kNoRegion);
  EXPECT_NEAR(map.touched()[0].time_over_threshold, kStep, 1e-15);
  const nlohmann::ordered_json json = toJson(map.summary(), map.touched().size());
  EXPECT_TRUE(json["peak_region"].is_null());
  ASSERT_EQ(json["by_region"].size(), 1U);
  EXPECT_TRUE(json["by_region"][0]["region"].is_null());
  EXPECT_NEAR(json["by_region"][0]["integral"].get<double>(), 0.3 * kStep, 1e-15);
}

TEST(WallForceReport, ReportsTheRegionOfThePeak)
{
  WallForceMap map(0.1, strip(10));
  EXPECT_TRUE(toJson(map.summary(), 0)["peak_position"].is_null());
  map.add({contactOf(0, 0.05), contactOf(9, 0.2, {1.0, 2.0, 3.0})}, kStep, kStep);
  const nlohmann::ordered_json json = toJson(map.summary(), map.touched().size());
  EXPECT_EQ(json["peak_region"], "far");
  EXPECT_EQ(json["peak_position"], nlohmann::ordered_json::array({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["triangles"], 2);
  EXPECT_EQ(json["by_region"][0]["region"], "near");
}

TEST(WallForceReport, WritesARowPerTriangleSortedByIndex)
{
  WallForceRow later{{7, 0, 0.5, 2.0, 0.25, 0.001}, {1.0, 2.0, 3.0}, "left \"a\", b"};
  WallForceRow earlier{{3, kNoRegion, 0.25, 1.0, 0.125, 0.0}, {0.0, 0.0, 0.5}, ""};
  EXPECT_EQ(wallForcesCsv({later, earlier}),
            "triangle,x,y,z,region,peak,peak_time,integral,time_over_threshold\n"
            "3,0,0,0.5,,0.25,1,0.125,0\n"
            "7,1,2,3,\"left \"\"a\"\", b\",0.5,2,0.25,0.001\n");
}

TEST(WallForceReport, SamplesTheVerticesOfTheVesselUniformly)
{
  const std::vector<Eigen::Vector3d> vertices(11, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(vesselPointsCsv(vertices, 4), "x,y,z\n1,2,3\n1,2,3\n1,2,3\n1,2,3\n");
  EXPECT_EQ(vesselPointsCsv({vertices.begin(), vertices.begin() + 2}, 4), "x,y,z\n1,2,3\n1,2,3\n");
}

// Pushes a wire into the bend of a tube and compares the map with a separate sum over all steps and contacts.
TEST(WallForceMap, EqualsTheSumOverTheStepsOfARun)
{
  const scene::Scene scene =
      scene::loadScene(PROJECT_DIR "/config/scenes/tube.yaml",
                       {"record.wall_force_threshold=0.01", "drive.initial_insertion=0.05", "drive.travel=0.08"});
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
  contact::Detector wall(vessel.mesh, scene::wallLaw(*scene.vessel));
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &wall);
  WallForceMap map(scene.record.wall_force_threshold, vessel);
  double integral = 0.0, peak = 0.0, peak_sum = 0.0;
  std::size_t contacts_without_triangle = 0;
  for (int k = 1; k <= 1000; ++k)
  {
    const double end = k * scene.solver.time_step;
    simulation.step(
        {scene.instruments.front().drive.insertionAt(end), scene.instruments.front().drive.rotationAt(end)});
    const std::vector<simulation::WallContact> contacts = simulation::wallContacts(simulation);
    map.add(contacts, simulation.time(), scene.solver.time_step);
    double sum = 0.0;
    for (const Eigen::Vector3d& force : simulation.state().wall_force)  // independent of wallContacts()
    {
      sum += force.norm();
      peak = std::max(peak, force.norm());
    }
    peak_sum = std::max(peak_sum, sum);
    integral += sum * scene.solver.time_step;
    for (const simulation::WallContact& contact : contacts)
      contacts_without_triangle += contact.triangle < 0;
  }
  const WallForceSummary summary = map.summary();
  ASSERT_GT(peak, 0.01);
  EXPECT_EQ(contacts_without_triangle, 0U);
  EXPECT_NEAR(summary.whole.integral, integral, 1e-9 * integral);
  EXPECT_EQ(summary.whole.peak, peak);
  EXPECT_NEAR(summary.whole.peak_sum, peak_sum, 1e-9 * peak_sum);
  EXPECT_GT(summary.whole.time_over_threshold, 0.0);
  double of_triangles = 0.0, of_regions = 0.0;
  for (const WallForce& record : map.touched())
    of_triangles += record.integral;
  for (const WallForceTotals& region : summary.regions)
    of_regions += region.integral;
  // Two facets that meet at 7.5° push with more than the sum of their forces.
  EXPECT_GT(of_triangles, integral);
  EXPECT_LT(of_triangles, 1.001 * integral / std::cos(M_PI / 48));
  EXPECT_NEAR(of_regions, integral, 1e-9 * integral);
}

// A node between two facets was booked on one of them: the vector sum erred by sin(3.75°) = 6.5 % across the load.
TEST(WallForceMap, VectorSumOfATubeWithFortyEightFacetsEqualsThatOfTheContacts)
{
  for (const double roll : {0.0, 1.0 / 96, 1.0 / 48})  // turns: the bend presses on a facet, or between two facets
  {
    const scene::Scene scene =
        scene::loadScene(PROJECT_DIR "/config/scenes/tube.yaml",
                         {"drive.initial_insertion=0.05", "drive.travel=0.08", "drive.rotation.amplitude=0",
                          "vessel.tube.pieces.1.plane_angle=" + std::to_string(2.0 * M_PI * roll)});
    const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
    contact::Detector wall(vessel.mesh, scene::wallLaw(*scene.vessel));
    simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &wall);
    WallForceMap map(scene.record.wall_force_threshold, vessel);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 1; k <= 1500; ++k)
    {
      simulation.step({scene.instruments.front().drive.insertionAt(k * scene.solver.time_step), 0.0});
      map.add(simulation::wallContacts(simulation), simulation.time(), scene.solver.time_step);
      for (const Eigen::Vector3d& force : simulation.state().wall_force)
        sum += scene.solver.time_step * force;
    }
    Eigen::Vector3d of_map = Eigen::Vector3d::Zero();
    for (const WallForce& record : map.touched())
    {
      const Eigen::Vector3i& corners = vessel.mesh.triangles[static_cast<std::size_t>(record.triangle)];
      const std::vector<Eigen::Vector3d>& x = vessel.mesh.vertices;
      const Eigen::Vector3d normal = (x[corners[1]] - x[corners[0]]).cross(x[corners[2]] - x[corners[0]]).normalized();
      of_map -= record.integral * normal;  // normals of the mesh point out of the lumen
    }
    EXPECT_GT(sum.norm(), 1e-3);
    EXPECT_LT((of_map - sum).norm(), 1e-3 * sum.norm())
        << roll << ": " << of_map.transpose() << ", " << sum.transpose();
  }
}

/** Contact source with a single contact at a given point of an edge. */
class OneTouch : public contact::ContactSource
{
public:
  explicit OneTouch(double parameter) : parameter_(parameter) {}

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    set.step = query.step;
    set.substep = query.substep;
    set.pass = query.pass;
    set.stale = false;
    set.first_edge = query.first_node;
    set.free_distance.assign(query.nodes.size() - 1, query.margin.front());
    const std::size_t edge = query.nodes.size() - 3;
    contact::Feature feature;
    feature.edge = query.first_node + static_cast<int>(edge);
    feature.parameter = parameter_;
    feature.normal = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d axis = (1.0 - parameter_) * query.nodes[edge] + parameter_ * query.nodes[edge + 1];
    feature.gap = axis.x() - 10e-6;  // penetration of 10 µm at the straight wire
    feature.point = axis - (feature.gap + query.radius[edge]) * feature.normal;
    feature.triangle = 7;
    feature.id = 21;
    set.features = {feature};
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }

private:
  double parameter_;
};

TEST(WallContacts, ReportTheTriangleAtBothNodesOfAContactedEdge)
{
  for (const double parameter : {0.3, 0.5, 0.8})
  {
    const scene::Scene scene = scene::loadScene(PROJECT_DIR "/config/scenes/straight_wire.yaml",
                                                {"drive.initial_insertion=0.1", "drive.travel=0.01"});
    scene::EntryPose entry;
    entry.d1 = Eigen::Vector3d::UnitY();
    OneTouch wall(parameter);
    simulation::Simulation simulation(scene, entry, &wall);
    simulation.step({0.1, 0.0});  // the contact pushes the wire away
    const std::vector<simulation::WallContact> contacts = simulation::wallContacts(simulation);
    ASSERT_EQ(contacts.size(), 2U) << parameter;
    for (const simulation::WallContact& contact : contacts)
      EXPECT_EQ(contact.triangle, 7) << parameter << ", node " << contact.node;
    EXPECT_EQ(contacts[0].position, contacts[1].position);
  }
}

}  // namespace
}  // namespace endovascular_sim::results
