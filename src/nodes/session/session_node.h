#pragma once

#include <ros/ros.h>

#include "nodes/session/session_recorder.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** ROS node of a session: records its messages and writes its report. */
class SessionNode
{
public:
  /** @param parameters handle of the private parameters
   *  @throws InputError when the folder of the results cannot be used */
  SessionNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters, const scene::Scene& scene);

  /** Records until the session ends, ROS shuts down, or SIGINT or SIGTERM arrives.
   *  @return true when the recording is complete */
  bool run();

private:
  void endGraph() const;

  bool ends_graph_;
  SessionRecorder recorder_;
};

}  // namespace endovascular_sim::nodes
