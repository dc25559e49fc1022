#include <cstdio>

#include <geometry_msgs/Point.h>
#include <ros/console.h>

#include "common/hash.h"
#include "nodes/conversions/contact_conversions.h"
#include "session/session.h"

int main()
{
  endovascular_sim::session::Session session("tube");
  session.step(static_cast<int>(session.lastStep()));
  const geometry_msgs::Point tip = endovascular_sim::nodes::toPoint(session.observe().tip(0).position);
  ROS_INFO("tip at %.4f %.4f %.4f m", tip.x, tip.y, tip.z);
  std::printf("trajectory_hash %s\n", endovascular_sim::Hash64::toHex(session.simulation().trajectoryHash()).c_str());
}
