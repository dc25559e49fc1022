#include "nodes/player/recorded_texts.h"

#include <std_msgs/String.h>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/session_bag.h"
#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{

RecordedTexts recordedTexts(const std::string& file)
{
  RecordedTexts texts;
  readBagMessages(file,
                  [&texts](const BagMessage& message)
                  {
                    try
                    {
                      if (isTopic(message.topic, names::kSessionInfo))
                        texts.scene = sessionInfo(message).scene_yaml;
                      else if (isTopic(message.topic, names::kRobotDescriptionTopic) && message.is<std_msgs::String>())
                        texts.urdf = message.read<std_msgs::String>()->data;
                    }
                    catch (const ros::Exception&)
                    {
                      return;  // the bytes of the message are damaged
                    }
                  });
  if (!texts.urdf.empty() || texts.scene.find("\nrobot:") == std::string::npos)
    return texts;
  try
  {
    const scene::Scene scene = scene::parseRecordedScene(texts.scene, file);
    if (scene.robot)
      texts.urdf = scene.robot->model.urdf;
  }
  catch (const InputError&)
  {
    return texts;  // the scene, or the file of its robot, is not of this computer: no robot
  }
  return texts;
}

}  // namespace endovascular_sim::nodes
