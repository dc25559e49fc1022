#pragma once

#include <string>

#include "endovascular_sim/TreatmentVisual.h"
#include "visualization/tube_surface.h"

namespace endovascular_sim::rviz_plugin
{

/** Surfaces of the balloons and stents of a message. Independent of Ogre. */
class TreatmentDrawing
{
public:
  /** Draws a message.
   *  @return reason why nothing is drawn; empty for a valid message */
  std::string update(const TreatmentVisual& message);
  void clear();

  const visualization::Surface& balloons() const { return balloons_; }
  const visualization::Surface& struts() const { return struts_; }

private:
  visualization::Surface balloons_, struts_;
};

}  // namespace endovascular_sim::rviz_plugin
