#include "results/trajectory_csv.h"

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"

namespace endovascular_sim::results
{
namespace
{

std::vector<std::string> linesOf(const std::string& file)
{
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

TEST(TrajectoryFile, WritesNumbersThatReadBackToTheSameBits)
{
  TrajectoryRow row;
  row.insertion = 0.1 + 0.2;
  row.pressure = 1e6 / 3.0;
  row.tip_rotation = -1.0 / 7.0;
  row.tip = {1.0 / 3.0, -2.0 / 7.0, 1e-17};
  std::istringstream text(toCsv(row));
  std::vector<double> values;
  for (std::string cell; std::getline(text, cell, ',');)
    values.push_back(std::stod(cell));
  ASSERT_EQ(values.size(), 11U);
  EXPECT_EQ(values[1], row.insertion);
  EXPECT_EQ(values[5], row.tip.x());
  EXPECT_EQ(values[6], row.tip.y());
  EXPECT_EQ(values[7], row.tip.z());
  EXPECT_EQ(values[9], row.pressure);
  EXPECT_EQ(values[10], row.tip_rotation);
}

TEST(TrajectoryFile, ReportsAtTheNextRowThatItsFolderWasRemoved)
{
  const std::string folder = testing::TempDir() + "endovascular_sim_removed";
  std::filesystem::create_directories(folder);
  TrajectoryFile trajectory(folder + "/trajectory.csv", 100.0);
  TrajectoryRow row;
  ASSERT_TRUE(trajectory.add(row));
  std::filesystem::remove_all(folder);
  row.time = 0.01;
  EXPECT_FALSE(trajectory.add(row));
  EXPECT_NE(trajectory.error().find("was removed"), std::string::npos) << trajectory.error();
}

TEST(TrajectoryFile, WritesOneRowPerSlotAtAnyInputRate)
{
  const std::string file = testing::TempDir() + "endovascular_sim_rows.csv";
  {
    TrajectoryFile trajectory(file, 100.0);
    for (int step = 1; step <= 1000; ++step)
    {
      TrajectoryRow row;
      row.time = 1e-3 * step;
      EXPECT_TRUE(trajectory.add(row));
    }
    EXPECT_TRUE(trajectory.flush());
  }
  const std::vector<std::string> lines = linesOf(file);
  ASSERT_EQ(lines.size(), 1U + 101U);  // header, initial slot, 100 others
  EXPECT_EQ(lines[0], kTrajectoryColumns);
  EXPECT_EQ(lines[2].substr(0, 5), "0.01,");
  EXPECT_EQ(lines[101].substr(0, 2), "1,");
  std::remove(file.c_str());
}

TEST(TrajectoryFile, RejectsAMissingFolder)
{
  EXPECT_THROW(TrajectoryFile("/no/such/folder/trajectory.csv", 100.0), InputError);
}

}  // namespace
}  // namespace endovascular_sim::results
