#include "results/step_costs_csv.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"

namespace endovascular_sim::results
{
namespace
{

std::vector<std::string> cells(const std::string& line)
{
  std::vector<std::string> found;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    found.push_back(cell);
  return found;
}

TEST(StepCostsFile, HasOneRowPerStepWithAllColumns)
{
  const std::string file = testing::TempDir() + "step_costs.csv";
  const scene::Scene scene = scene::loadScene(PROJECT_DIR "/config/scenes/straight_wire.yaml");
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
  StepCostsFile costs(file);
  for (int k = 1; k <= 3; ++k)
  {
    const double end = k * scene.solver.time_step;
    simulation.step({scene.instruments.front().drive.insertionAt(end), 0.0});
    costs.add(simulation, 50e-6);
  }
  ASSERT_TRUE(costs.flush());
  std::ifstream stream(file);
  std::string line;
  ASSERT_TRUE(std::getline(stream, line));
  EXPECT_EQ(line,
            "step,us,solves,factorisations,truncations,hit_iteration_limit,contacts,detections,collision_us,assembly_"
            "us,solve_us,"
            "sampling_us,twist_us,contact_us,friction_us,layers_us,forces_us,balloon_us,blood_us,control_us");
  const std::size_t columns = cells(line).size();
  for (int k = 1; k <= 3; ++k)
  {
    ASSERT_TRUE(std::getline(stream, line));
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), columns);
    EXPECT_EQ(row[0], std::to_string(k));
    EXPECT_EQ(row[1], "50");
    EXPECT_GE(std::stoi(row[2]), 1) << "solves";
    EXPECT_EQ(row[6], "0") << "number of contacts without a vessel";
    EXPECT_GT(std::stod(row[10]), 0.0) << "time of solving";
  }
  EXPECT_FALSE(std::getline(stream, line));
  std::filesystem::remove(file);
}

TEST(StepCostsFile, RejectsAMissingFolder)
{
  EXPECT_THROW(StepCostsFile(testing::TempDir() + "no_such_folder/costs.csv"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::results
