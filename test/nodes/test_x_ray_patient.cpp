#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "nodes/runtime/ros_names.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kPatience = 100.0;  // the body of a new vessel takes seconds of processor time [s]
constexpr int kFrames = 12;          // the body is refined within 9

/** Counts of an image_raw in ascending order. */
std::vector<std::uint16_t> sortedCounts(const sensor_msgs::Image& image)
{
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(image.width) * image.height);
  std::memcpy(counts.data(), image.data.data(), std::min(image.data.size(), 2 * counts.size()));
  std::sort(counts.begin(), counts.end());
  return counts;
}

TEST(XRayPatient, TheBodyOfTheSceneAppearsInTheImage)
{
  int frames = 0;
  sensor_msgs::Image last;
  TopicObserver observer;
  observer.subscribe<sensor_msgs::Image>(names::kFluoroscopyRaw,
                                         [&](const sensor_msgs::Image& image)
                                         {
                                           ++frames;
                                           last = image;
                                         });
  ASSERT_TRUE(waitUntil(kPatience, [&] { return observer.copy(frames) >= kFrames; }));
  const std::vector<std::uint16_t> counts = sortedCounts(observer.copy(last));
  ASSERT_EQ(counts.size(), 128U * 128U);
  const double dark = counts[counts.size() / 20], bright = counts[counts.size() - counts.size() / 20];
  EXPECT_GT(bright, 2.0 * dark) << "spine and gas; a slab differs by its noise only";
}

TEST(XRayPatient, AFileThatIsNoVolumeIsReportedAndGivesNoImage)
{
  int frames = 0, level = -1;
  std::string message;
  TopicObserver observer;
  observer.subscribe<sensor_msgs::Image>("refused/fluoroscopy/image_raw",
                                         [&](const sensor_msgs::Image& /*image*/) { ++frames; });
  observer.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics",
      [&](const diagnostic_msgs::DiagnosticArray& array)
      {
        for (const diagnostic_msgs::DiagnosticStatus& status : array.status)
          if (status.name.find("refused/fluoroscopy") != std::string::npos)
          {
            level = status.level;
            message = status.message;
          }
      });
  EXPECT_TRUE(waitUntil(kPatience, [&] { return observer.copy(level) == diagnostic_msgs::DiagnosticStatus::ERROR; }));
  EXPECT_NE(observer.copy(message).find("thick_wire.yaml"), std::string::npos) << observer.copy(message);
  EXPECT_EQ(observer.copy(frames), 0);
}

}  // namespace
}  // namespace endovascular_sim::nodes
