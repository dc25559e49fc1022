#pragma once

#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "motion/map/motion_map.h"
#include "nodes/visualization/motion_history.h"

namespace endovascular_sim::rviz_plugin
{

/** Pairs each state of the instruments with the patient's motion of the same step, in whatever order they arrive. A
 *  frame's difference would be up to 2 mm in the picture.
 *
 *  Without motions a state is shown at once, in a patient at rest. A state whose motion does not arrive, e.g. after a
 *  jump of a recording, is shown after kPatience with the motion of the nearest step. After kMostWithout such states
 *  the motion has ended: the patient is at rest. */
class MotionFollower
{
public:
  static constexpr double kPatience = 0.1;  ///< longest wait for the motion of a state [s]
  static constexpr int kMostWithout = 20;   ///< states without a motion after which the patient is at rest

  /** @throws InputError for an impossible motion */
  void add(const MotionState& motion);
  /** Takes a state, which replaces one that waits. */
  void add(const RodStateVisualConstPtr& wire);
  /** Forgets the states of the instruments. */
  void clearWires();

  /** Chooses what is shown from now on.
   *  @param seconds since the last call
   *  @return true if it is another state, or another map */
  bool advance(double seconds);

  /** Shown state; null before the first one. */
  const RodStateVisualConstPtr& wire() const { return wire_; }
  /** Map of the shown state. */
  const motion::MotionMap& map() const { return map_; }

private:
  bool showNewestMotion();
  void show(const motion::MotionMap& map);

  nodes::MotionHistory motions_;
  RodStateVisualConstPtr waiting_, wire_;
  motion::MotionMap map_ = nodes::restingMap();
  double waited_ = 0.0;  ///< since the last shown state, while another one waits [s]
  int without_ = 0;      ///< states since the last motion
  bool is_motion_new_ = false;
};

}  // namespace endovascular_sim::rviz_plugin
