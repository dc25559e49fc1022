#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <thread>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

namespace
{

constexpr double kForce = 0.5;     ///< [N]
constexpr double kTorque = 0.005;  ///< [N·m]

/** Substitute of the simulation at 1 kHz: accepts every motion and publishes a constant force. */
class Graph
{
public:
  Graph()
  {
    const auto no_delay = ros::TransportHints().tcpNoDelay();
    force_ = node_.advertise<sensor_msgs::JointState>("instruments/guidewire/setpoint_js", 10);
    servo_ = node_.subscribe("instruments/guidewire/servo_jp", 1000, &Graph::receiveMotion, this, no_delay);
    measured_ = node_.subscribe("haptic/hand/measured_js", 1000, &Graph::receiveMeasured, this, no_delay);
    state_ = node_.subscribe("haptic/hand/operating_state", 10, &Graph::receiveState, this, no_delay);
    reason_ = node_.subscribe("haptic/hand/state_reason", 10, &Graph::receiveReason, this, no_delay);
    diagnostics_ = node_.subscribe("/diagnostics", 10, &Graph::receiveDiagnostics, this, no_delay);
    spinner_.start();
    thread_ = std::thread(&Graph::publishForces, this);
  }

  ~Graph()
  {
    running_ = false;
    thread_.join();
    spinner_.stop();
  }

  void setPublishing(bool on)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    publishes_ = on;
    silent_since_ = ros::Time::now();
  }

  template <typename Condition>
  bool waitFor(double seconds, Condition condition)
  {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::WallTime::now() < end)
    {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (condition())
          return true;
      }
      ros::WallDuration(2e-3).sleep();
    }
    return false;
  }

  // Guarded by mutex_; conditions given to waitFor() may read them.
  std::size_t motions = 0;
  double insertion = 0.0;
  double largest_jump = 0.0;
  sensor_msgs::JointState measured;
  std::size_t late_forces = 0;  ///< non-zero forces later than 100 ms after the last force of the simulation
  std::string state;
  std::string reason;
  std::string reconnects;

private:
  void publishForces()
  {
    while (running_ && ros::ok())
    {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (publishes_)
        {
          sensor_msgs::JointState message;
          message.header.stamp = ros::Time::now();
          message.name = {"insertion", "rotation"};
          message.position = command_;
          message.effort = {kForce, kTorque};
          force_.publish(message);
        }
      }
      ros::WallDuration(1e-3).sleep();
    }
  }

  void receiveMotion(const sensor_msgs::JointState& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ASSERT_EQ(message.name, (std::vector<std::string>{"insertion", "rotation"}));
    ASSERT_EQ(message.position.size(), 2U);
    if (motions > 0)
      largest_jump = std::max(largest_jump, std::abs(message.position[0] - insertion));
    insertion = message.position[0];
    command_ = message.position;
    ++motions;
  }

  void receiveMeasured(const sensor_msgs::JointState& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    measured = message;
    if (!publishes_ && message.effort.at(0) != 0.0 && message.header.stamp > silent_since_ + ros::Duration(0.1))
      ++late_forces;
  }

  void receiveState(const crtk_msgs::OperatingState& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state = message.state;
  }

  void receiveReason(const crtk_msgs::StringStamped& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    reason = message.string;
  }

  void receiveDiagnostics(const diagnostic_msgs::DiagnosticArray& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& status : message.status)
      for (const auto& value : status.values)
        if (value.key == "reconnects")
          reconnects = value.value;
  }

  ros::NodeHandle node_;
  std::mutex mutex_;
  bool publishes_ = true;
  ros::Time silent_since_;
  std::vector<double> command_ = {0.0, 0.0};  ///< the simulation publishes from its first step on
  ros::Publisher force_;
  ros::Subscriber servo_;
  ros::Subscriber measured_;
  ros::Subscriber state_;
  ros::Subscriber reason_;
  ros::Subscriber diagnostics_;
  ros::AsyncSpinner spinner_{2};
  std::atomic<bool> running_{true};
  std::thread thread_;
};

TEST(HapticDeviceNode, ExchangesMotionAndForceFadesOnSilenceAndRecoversFromAnUnplug)
{
  Graph graph;
  ASSERT_TRUE(graph.waitFor(30.0, [&] { return graph.motions > 500 && graph.state == "ENABLED"; }))
      << "the motion of the device arrives; state " << graph.state << ", " << graph.reason;
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.measured.effort.at(0) == kForce; })) << "the force returns";
  EXPECT_EQ(graph.measured.effort.at(1), kTorque);
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.insertion > 0.01; })) << "the hand moves";

  graph.setPublishing(false);
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.state == "PAUSED" && graph.measured.effort.at(0) == 0.0; }));
  const std::size_t motions = graph.motions;
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.motions > motions + 300; })) << "motion continues";
  EXPECT_EQ(graph.late_forces, 0U) << "the force is zero 100 ms after the last force of the simulation";
  graph.setPublishing(true);
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.measured.effort.at(0) == kForce; }));

  ASSERT_TRUE(graph.waitFor(20.0, [&] { return graph.state == "DISABLED"; })) << "the device is unplugged";
  ASSERT_TRUE(graph.waitFor(1.0, [&] { return graph.measured.header.stamp.isZero(); })) << "marked as invalid";
  EXPECT_EQ(graph.measured.effort.at(0), 0.0);
  const double held = graph.insertion;
  ASSERT_TRUE(graph.waitFor(10.0, [&] { return graph.state == "ENABLED"; })) << graph.reason;
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.insertion > held + 0.005; })) << "motion continues";
  ASSERT_TRUE(graph.waitFor(5.0, [&] { return graph.measured.effort.at(0) == kForce; }));
  EXPECT_LT(graph.largest_jump, 5e-3) << "without a jump";
  EXPECT_TRUE(graph.waitFor(5.0, [&] { return graph.reconnects == "1"; })) << graph.reconnects;
}

}  // namespace
