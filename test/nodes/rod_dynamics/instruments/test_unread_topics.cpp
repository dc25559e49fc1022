#include "nodes/rod_dynamics/instruments/unread_topics.h"

#include <gtest/gtest.h>

#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{
namespace
{

const scene::Scene& twoInstruments()
{
  static const scene::Scene scene = []
  {
    scene::Scene loaded = scene::loadScene(PROJECT_DIR "/test/data/robot_instruments.yaml");
    loaded.instruments[1].drive.source = scene::DriveSource::kScript;
    return loaded;
  }();
  return scene;
}

std::string remedyFor(const std::string& topic, const std::string& publisher = "/robot")
{
  const std::vector<UnreadTopic> unread =
      unreadTopics(twoInstruments(), "/lab/instruments/", {{topic, {publisher}}}, "/rod_dynamics");
  return unread.empty() ? "" : unread.front().remedy;
}

TEST(UnreadTopics, AreNoneForInputsOfACommandedInstrument)
{
  EXPECT_EQ(remedyFor("/lab/instruments/wire/servo_jp"), "");
  EXPECT_EQ(remedyFor("/lab/instruments/wire/state_command"), "");
  EXPECT_EQ(remedyFor("/lab/instruments/wire/measured_js", "/rod_dynamics"), "");
  EXPECT_EQ(remedyFor("/instruments/wyre/servo_jp"), "") << "of another graph";
}

TEST(UnreadTopics, OfAnUnknownInstrumentNameTheNearestOne)
{
  EXPECT_EQ(remedyFor("/lab/instruments/wir/servo_jv"),
            "the scene has no instrument 'wir'; publish to /lab/instruments/wire/servo_jv");
  EXPECT_NE(remedyFor("/lab/instruments/guidewire_035_j/servo_jp").find("publish to /lab/instruments/"),
            std::string::npos);
}

TEST(UnreadTopics, OfAnUnsupportedCommandNameTheNearestOne)
{
  EXPECT_EQ(remedyFor("/lab/instruments/wire/servo_cp"),
            "instruments have no input 'servo_cp'; publish to /lab/instruments/wire/servo_jp");
}

TEST(UnreadTopics, OfAScriptedInstrumentNameTheKey)
{
  EXPECT_EQ(remedyFor("/lab/instruments/stent_system/servo_jp"),
            "the scene drives 'stent_system' itself; set instruments.1.drive.source=topic");
}

}  // namespace
}  // namespace endovascular_sim::nodes
