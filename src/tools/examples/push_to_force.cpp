// Pushes an instrument until the wall resists with a force, and holds that force, by velocities in real time. Start, in
// two terminals:
//
//     roslaunch endovascular_sim sim.launch scene:=$(rospack find endovascular_sim)/config/scenes/fork.yaml
//     rosrun endovascular_sim push_to_force _force:=0.1

#include <algorithm>
#include <cmath>
#include <string>

#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

namespace
{

constexpr double kRate = 100.0;  ///< of the loop [Hz]
constexpr double kGain = 0.1;    ///< speed per difference of the force [m/(s·N)]
constexpr double kMost = 0.03;   ///< largest speed [m/s]
constexpr int kHeld = 200;       ///< number of cycles in which the force is held

}  // namespace

int main(int argc, char** argv)
{
  ros::init(argc, argv, "push_to_force", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::NodeHandle parameters("~");
  const std::string topic = "instruments/" + parameters.param<std::string>("instrument", "guidewire") + "/";
  const double wanted = parameters.param("force", 0.1);      // [N]
  const double longest = parameters.param("seconds", 60.0);  // until the force is reached [s]

  double force = NAN;  // not a number before the first measurement
  const boost::function<void(const geometry_msgs::WrenchStampedConstPtr&)> measure =
      [&force](const geometry_msgs::WrenchStampedConstPtr& message)
  {
    const geometry_msgs::Vector3& sum = message->wrench.force;
    force = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  };
  const ros::Subscriber subscriber = node.subscribe<geometry_msgs::WrenchStamped>(
      topic + "measured_cf", 1, measure, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  const ros::Publisher velocity = node.advertise<sensor_msgs::JointState>(topic + "servo_jv", 1);

  sensor_msgs::JointState command;
  double sum = 0.0;
  int held = -1;  // cycles since the force was reached; negative before
  const ros::Time begin = ros::Time::now();
  for (ros::Rate rate(kRate); ros::ok() && held < kHeld; rate.sleep())
  {
    ros::spinOnce();
    const double elapsed = (ros::Time::now() - begin).toSec();
    if (held < 0 && elapsed > longest)
    {
      ROS_ERROR("%.3f N on %smeasured_cf after %.0f s", force, topic.c_str(), elapsed);
      return 1;
    }
    if (std::isnan(force))
      continue;
    if (held < 0 && force >= wanted)
    {
      ROS_INFO("reached %.3f N after %.1f s", force, elapsed);
      held = 0;
    }
    command.velocity = {std::clamp(kGain * (wanted - force), -kMost, kMost), 0.0};
    velocity.publish(command);
    if (held >= 0)
      sum += force;
    held += held >= 0 ? 1 : 0;
  }
  ROS_INFO("held %.3f N in the mean of %.0f s", sum / kHeld, kHeld / kRate);
  return 0;
}
