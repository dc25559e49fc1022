#pragma once

#include <string>

#include "endovascular_sim/TreatmentVisual.h"
#include "motion/map/motion_map.h"
#include "visualization/tube_surface.h"

namespace endovascular_sim::rviz_plugin
{

/** Surfaces of the balloons and stents of a message. Independent of Ogre. */
class TreatmentDrawing
{
public:
  /** Draws a message, whose bodies are those of the resting patient, in the moved one. Radii do not change.
   *  @return reason why nothing is drawn; empty for a valid message */
  std::string update(const TreatmentVisual& message, const motion::MotionMap& map);
  void clear();

  const visualization::Surface& balloons() const { return balloons_; }
  const visualization::Surface& struts() const { return struts_; }

private:
  visualization::Surface balloons_, struts_;
};

}  // namespace endovascular_sim::rviz_plugin
