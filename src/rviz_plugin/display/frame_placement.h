#pragma once

#include <string>

namespace Ogre
{
class SceneNode;
}
namespace rviz
{
class Display;
class DisplayContext;
}  // namespace rviz

namespace endovascular_sim::rviz_plugin
{

/** Moves the scene node of a display to a frame of tf. Without a transform to the fixed frame, the display gets the
 * error status "Transform".
 *  @return true if the transform is known */
bool placeInFrame(rviz::Display& display, rviz::DisplayContext& context, const std::string& frame,
                  Ogre::SceneNode& node);

}  // namespace endovascular_sim::rviz_plugin
