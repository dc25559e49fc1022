#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <geometry_msgs/Point.h>
#include <sensor_msgs/Image.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "intervention/vessel_dilatation.h"

namespace endovascular_sim::nodes
{

/** Largest coordinate of a position, beyond every patient [m]. */
constexpr double kFarthest = 1000.0;

/** @param topic, key named by the error
 *  @throws InputError for a coordinate that is not finite, or beyond kFarthest */
void requirePosition(const geometry_msgs::Point& position, const std::string& topic, const std::string& key);

/** The same for a radius that is negative, not finite, or beyond every vessel. */
void requireRadius(double radius, const std::string& topic, const std::string& key);

/** Body of revolution.
 *  @throws InputError for an axis that is too long, and for points and radii as above */
intervention::RoundBody roundBody(const std::vector<geometry_msgs::Point>& axis, const std::vector<double>& radius,
                                  const std::string& topic);

// Checks of messages from other processes. They throw InputError for lists of wrong lengths, for numbers that are not
// finite, and for numbers beyond every use.

/** A wire outside of the introducer has no nodes.
 *  @param largest_margin [m] */
void requireUsable(const RodState& state, double largest_margin);
/** Without a check of the lists of instruments. */
void requireUsable(const RodStateVisual& state);
/** @param instruments number of the scene's instruments */
void requireUsable(const RodStateVisual& state, std::size_t instruments);
void requireUsable(const DriveApplied& drive, std::size_t instruments);
void requireUsable(const ContactForces& forces);
void requireUsable(const ContactForceMap& map);
void requireUsable(const sensor_msgs::Image& image);

}  // namespace endovascular_sim::nodes
