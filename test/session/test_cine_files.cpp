#include "session/cine_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::session
{
namespace
{

std::shared_ptr<const World> tube()
{
  return World::open("tube", {"fluoroscopy={pixels: 64, follow_tip: false}"});
}

std::vector<std::string> linesOf(const std::string& file)
{
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

std::size_t filesIn(const std::string& folder)
{
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(CineFiles, WriteTheFramesOfAnIntervalByTheirPulses)
{
  const TemporaryFolder folder;
  const auto world = tube();
  Session session(world);
  XRayRunSettings settings;
  settings.views = {"", "LAO 40"};
  settings.mask_frames = 2;
  CineFiles files(*world, settings, cineTimeOf("0.1:0.4"), folder.path());
  for (files.update(session); session.simulation().steps() < 500; files.update(session))
    session.step();
  EXPECT_EQ(files.finish(), "");
  EXPECT_EQ(files.frames(), 5U);  // pulses 2 to 6
  const std::vector<std::string> lines = linesOf(folder.file("cine/frames.csv"));
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[0], "pulse,time,steps,tube_charge,reference_kerma,dsa");
  EXPECT_EQ(lines[1].substr(0, 2), "2,");
  EXPECT_NE(lines[2].find("3,0.20000000000000001,200,"), std::string::npos) << lines[2];
  EXPECT_EQ(lines[2].back(), '0');
  EXPECT_EQ(lines[3].back(), '1');
  for (const char* name :
       {"cine/frame_000002.png", "cine_2/frame_000006.png", "dsa/frame_000004.png", "dsa_2/frame_000006.png"})
    EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
  EXPECT_EQ(filesIn(folder.file("cine")), 6U);
  EXPECT_EQ(filesIn(folder.file("dsa")), 3U);
}

TEST(CineFiles, TellWhichFramesAreMissing)
{
  const TemporaryFolder folder;
  const auto world = tube();
  Session session(world);
  CineFiles files(*world, {}, {0.0, 1.0}, folder.path());
  for (files.update(session); session.simulation().steps() < 100; files.update(session))
    session.step();
  EXPECT_NE(files.finish().find("only 2 of 16 X-ray frames"), std::string::npos) << files.finish();
}

TEST(CineFiles, RefuseWhatIsNoRun)
{
  const TemporaryFolder folder;
  const auto world = tube();
  for (const char* text : {"", "1", "1:", ":2", "2:1", "-1:2", "0:inf", "0:1s", "a:b", "nan:1"})
    EXPECT_NE(inputErrorOf([&] { cineTimeOf(text); }).find("is no interval"), std::string::npos) << text;
  EXPECT_NE(inputErrorOf(
                [&] {
                  CineFiles(*world, {}, {0.01, 0.05}, folder.path());
                })
                .find("has no pulse"),
            std::string::npos);
  XRayRunSettings settings;
  settings.mask_frames = 4;
  EXPECT_NE(inputErrorOf(
                [&] {
                  CineFiles(*world, settings, {0.0, 0.2}, folder.path());
                })
                .find("the mask takes 4 frames, but the run has 4"),
            std::string::npos);
  for (const double roadmap : {0.2, 2.0})
  {
    settings.roadmap_at = roadmap;
    EXPECT_NE(inputErrorOf(
                  [&] {
                    CineFiles(*world, settings, {0.0, 1.0}, folder.path());
                  })
                  .find("must begin after the first frame of DSA, at 0.267 s, and by 1 s"),
              std::string::npos);
  }
}

TEST(CineFiles, EndTheRunOfDsaWhereTheRoadmapBegins)
{
  const TemporaryFolder folder;
  const auto world = tube();
  Session session(world);
  XRayRunSettings settings;
  settings.mask_frames = 1;
  settings.roadmap_at = 0.2;
  CineFiles files(*world, settings, {0.0, 0.3}, folder.path());
  for (files.update(session); session.simulation().steps() < 300; files.update(session))
    session.step();
  EXPECT_EQ(files.finish(), "");
  EXPECT_EQ(filesIn(folder.file("dsa")), 2U) << "pulses 1 and 2";
  EXPECT_EQ(linesOf(folder.file("cine/frames.csv"))[4].back(), '0');
}

}  // namespace
}  // namespace endovascular_sim::session
