#include "rviz_plugin/display/frame_placement.h"

#include <OgreSceneNode.h>
#include <ros/time.h>
#include <rviz/display.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>

namespace endovascular_sim::rviz_plugin
{

bool placeInFrame(rviz::Display& display, rviz::DisplayContext& context, const std::string& frame,
                  Ogre::SceneNode& node)
{
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context.getFrameManager()->getTransform(frame, ros::Time(), position, orientation))
  {
    display.setStatus(rviz::StatusProperty::Error, "Transform",
                      QString("no transform from %1 to the fixed frame").arg(frame.c_str()));
    return false;
  }
  display.deleteStatus("Transform");
  node.setPosition(position);
  node.setOrientation(orientation);
  return true;
}

}  // namespace endovascular_sim::rviz_plugin
