#include "nodes/session/private_text.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

const PrivateText kTexts("ward7", {{"/home/anna/runs", "WORKING_FOLDER"}, {"/home/anna", "~"}});

TEST(PrivateText, LosesHostAndFolders)
{
  EXPECT_EQ(kTexts.removedFrom("/rviz_ward7_123 in /home/anna/runs/a, not /home/anna/b"),
            "/rviz_host_123 in WORKING_FOLDER/a, not ~/b");
}

TEST(PrivateText, KeepsWordsThatOnlyContainAName)
{
  EXPECT_EQ(kTexts.removedFrom("ward70 and /home/annabel"), "ward70 and /home/annabel");
}

TEST(PrivateText, KeepsTheNameOfAFile)
{
  EXPECT_EQ(withoutFolder("/home/anna/vessel.stl"), "vessel.stl");
  EXPECT_EQ(withoutFolder("meshes/vessel.stl"), "meshes/vessel.stl");
}

}  // namespace
}  // namespace endovascular_sim::nodes
