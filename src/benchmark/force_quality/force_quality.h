#pragma once

#include <functional>
#include <limits>
#include <vector>

namespace endovascular_sim::benchmark
{

/** Motion of a handle and reaction on its hand after a step. */
struct HandReaction
{
  double insertion = 0.0;  ///< [m]
  double rotation = 0.0;   ///< [rad]
  double force = 0.0;      ///< [N]
  double torque = 0.0;     ///< [N·m]
};

/** Largest change of a reaction per millisecond, and its noise, while a handle moves steadily. */
struct ReactionQuality
{
  double largest_change = 0.0;  ///< over a millisecond, beyond that of the reference if there is one [N or N·m]
  double change_time = std::numeric_limits<double>::quiet_NaN();  ///< end of that millisecond [s]
  double deviation = 0.0;  ///< mean over the windows of the standard deviation about the trend [N or N·m]
  double mean = 0.0;       ///< mean over the windows of the magnitude [N or N·m]
  int windows = 0;         ///< number of windows with steady motion

  /** Standard deviation over the mean [1]; NaN without a window. */
  double noise() const;
};

/** Quality of the force and of the torque at one hand. */
struct HandQuality
{
  ReactionQuality force;   ///< in windows in which the handle is pushed or pulled
  ReactionQuality torque;  ///< in windows in which the handle is turned
};

/** Quasi-static force at the hand over the insertion [N], where a reference knows it. */
using ForceReference = std::function<double(double insertion)>;

/** Quality of the reaction at a hand. The run is divided into windows of 0.25 s. A window is steady if the handle moves
 * in one direction during all of it and 10 ms before and after, by at least 1 mm/s or 0.05 rad/s in every 10 ms. The
 * trend is the linear regression in time.
 *  @param reactions after every step
 *  @param time_step [s]
 *  @param reference empty: the change is that of the force itself */
HandQuality handQuality(const std::vector<HandReaction>& reactions, double time_step,
                        const ForceReference& reference = {});

}  // namespace endovascular_sim::benchmark
