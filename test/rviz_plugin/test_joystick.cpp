#include "rviz_plugin/model/joystick.h"

#include <fcntl.h>
#include <linux/joystick.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "test/common/temporary_folder.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** Named pipe in the place of the device. */
class JoystickTest : public ::testing::Test
{
protected:
  JoystickTest()
  {
    EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
    device = open(path.c_str(), O_RDWR | O_NONBLOCK);
  }
  ~JoystickTest() override { unplug(); }

  void send(int type, int number, int value) const
  {
    js_event event{};
    event.type = static_cast<__u8>(type);
    event.number = static_cast<__u8>(number);
    event.value = static_cast<__s16>(value);
    ASSERT_EQ(write(device, &event, sizeof event), static_cast<ssize_t>(sizeof event));
  }

  void unplug()
  {
    if (device >= 0)
      close(device);
    device = -1;
  }

  TemporaryFolder folder;
  const std::string path = folder.file("js0");
  int device = -1;
};

TEST_F(JoystickTest, ReadsSticksAndButtons)
{
  Joystick joystick(path);
  EXPECT_TRUE(joystick.poll(0.0).is_connected);
  send(JS_EVENT_AXIS, 1, -32767);
  send(JS_EVENT_AXIS, 0, 32767);
  send(JS_EVENT_BUTTON, 3, 1);
  send(JS_EVENT_BUTTON, 3, 0);
  JoystickState state = joystick.poll(0.1);
  EXPECT_DOUBLE_EQ(state.push, 1.0);
  EXPECT_DOUBLE_EQ(state.twist, 1.0);
  EXPECT_EQ(state.pressed, std::vector<int>{3});
  send(JS_EVENT_AXIS, 0, 0);
  send(JS_EVENT_AXIS, 3, -32767);  // the right stick
  state = joystick.poll(0.2);
  EXPECT_DOUBLE_EQ(state.push, 1.0);
  EXPECT_DOUBLE_EQ(state.twist, -1.0);
  EXPECT_TRUE(state.pressed.empty());
}

TEST_F(JoystickTest, HasADeadZoneAndNoButtonAtTheBeginning)
{
  Joystick joystick(path);
  joystick.poll(0.0);
  send(JS_EVENT_AXIS | JS_EVENT_INIT, 1, -2000);
  send(JS_EVENT_BUTTON | JS_EVENT_INIT, 0, 1);
  const JoystickState state = joystick.poll(0.1);
  EXPECT_EQ(state.push, 0.0);
  EXPECT_TRUE(state.pressed.empty());
}

TEST_F(JoystickTest, IsAtRestWhenItIsUnpluggedAndIsFoundAgain)
{
  Joystick joystick(path);
  joystick.poll(0.0);
  send(JS_EVENT_AXIS, 1, -32767);
  EXPECT_GT(joystick.poll(0.1).push, 0.5);
  unplug();
  EXPECT_FALSE(joystick.poll(0.2).is_connected);
  EXPECT_EQ(joystick.poll(0.3).push, 0.0);
  device = open(path.c_str(), O_RDWR | O_NONBLOCK);
  EXPECT_TRUE(joystick.poll(5.0).is_connected);
}

TEST(Joystick, IsAtRestWithoutADevice)
{
  Joystick joystick("/nonexistent/js0");
  const JoystickState state = joystick.poll(0.0);
  EXPECT_FALSE(state.is_connected);
  EXPECT_EQ(state.push, 0.0);
  EXPECT_EQ(state.twist, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
