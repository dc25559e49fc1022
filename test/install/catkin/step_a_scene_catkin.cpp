#include <cstdio>

#include <geometry_msgs/Point.h>
#include <ros/console.h>

#include "common/hash.h"
#include "nodes/conversions/contact_conversions.h"
#include "simulation/offline_session.h"

int main()
{
  endovascular_sim::simulation::OfflineSession session("tube");
  while (!session.isOver())
    session.step();
  const auto& simulation = session.simulation();
  const geometry_msgs::Point tip = endovascular_sim::nodes::toPoint(simulation.state().position.back());
  ROS_INFO("tip at %.4f %.4f %.4f m", tip.x, tip.y, tip.z);
  std::printf("trajectory_hash %s\n", endovascular_sim::Hash64::toHex(simulation.trajectoryHash()).c_str());
}
