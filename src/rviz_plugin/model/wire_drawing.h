#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "endovascular_sim/RodStateVisual.h"
#include "rviz_plugin/model/scene_summary.h"
#include "visualization/colour_legend.h"
#include "visualization/instrument_tubes.h"
#include "visualization/tube_surface.h"

namespace endovascular_sim::rviz_plugin
{

/** Surfaces of the instruments of a message. Independent of Ogre. */
class WireDrawing
{
public:
  explicit WireDrawing(int sides = 12) : builder_(sides) {}

  void setSides(int sides) { builder_ = visualization::TubeBuilder(sides); }
  void setScene(const SceneSummary& scene) { shapes_ = scene.shapes(); }
  void clearScene() { shapes_.clear(); }

  /** Draws a message. The full scale of the style applies if it is positive; else the scale follows the largest force.
   *  @return reason why nothing is drawn; empty for a valid message */
  std::string update(const RodStateVisual& message, const visualization::WireStyle& style);

  /** Begins the scale of the forces anew, at a time of a recording.
   *  @param largest force of the run up to then [N] */
  void restartScale(double largest);

  void clear();

  /** Vertices and triangles of all instruments. */
  const visualization::Surface& surface() const { return surface_; }
  const std::vector<std::uint32_t>& opaqueTriangles() const { return opaque_; }
  const std::vector<std::uint32_t>& translucentTriangles() const { return translucent_; }
  double fullForce() const { return full_force_; }        ///< force that is drawn red [N]
  double largestForce() const { return largest_force_; }  ///< of the last message [N]

private:
  std::string read(const RodStateVisual& message);
  void divideTriangles();

  visualization::TubeBuilder builder_;
  std::vector<visualization::InstrumentShape> shapes_;
  visualization::WireState state_, refined_;
  std::vector<visualization::TubeAxis> axes_;
  visualization::Surface surface_;
  std::vector<std::uint32_t> opaque_, translucent_;
  visualization::FollowingScale scale_{0.05};
  double full_force_ = 0.05;
  double largest_force_ = 0.0;
  double last_time_ = 0.0;       ///< simulated [s]
  double largest_before_ = 0.0;  ///< of restartScale(); 0 in a session [N]
};

}  // namespace endovascular_sim::rviz_plugin
