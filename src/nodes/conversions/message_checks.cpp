#include "nodes/conversions/message_checks.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "common/error.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kLargestRadius = 1.0;          ///< of instruments and vessels [m]
constexpr double kLargestFreeDistance = 100.0;  ///< [m]
constexpr double kLongestBody = 2.0;            ///< balloon or stent [m]
constexpr std::size_t kMostNodes = 100000;      ///< of a wire

bool isFinite(const geometry_msgs::Vector3& vector)
{
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

template <typename Number>
void requireFinite(const std::vector<Number>& values, const char* topic, const char* key)
{
  if (!std::all_of(values.begin(), values.end(), [](Number value) { return std::isfinite(value); }))
    throw InputError(topic, key, "must be finite");
}

/** Requires finite values within an interval. */
void requireWithin(const std::vector<double>& values, double least, double most, const char* topic, const char* key)
{
  if (!std::all_of(values.begin(), values.end(), [=](double value) { return value >= least && value <= most; }))
    throw InputError(topic, key, "must be between " + std::to_string(least) + " and " + std::to_string(most) + " m");
}

void requireSizes(std::initializer_list<std::size_t> sizes, std::size_t size, const char* topic, const char* keys,
                  const char* of)
{
  for (const std::size_t actual : sizes)
    if (actual != size)
      throw InputError(topic, keys,
                       "must have one element for each of the " + std::to_string(size) + " " + of + ", not " +
                           std::to_string(actual));
}

void requireNodes(const std::vector<geometry_msgs::Point>& nodes, const char* topic)
{
  if (nodes.size() > kMostNodes)
    throw InputError(topic, "nodes", "must be at most " + std::to_string(kMostNodes));
  const std::string topic_name = topic;  // once for all nodes of a wire, at every query
  const std::string key = "nodes";
  for (const geometry_msgs::Point& node : nodes)
    requirePosition(node, topic_name, key);
}

void requireFinite(const ContactForceTotals& totals)
{
  for (const double value :
       {totals.peak, totals.peak_time, totals.peak_sum, totals.peak_sum_time, totals.integral,
        totals.time_over_threshold, totals.peak_position.x, totals.peak_position.y, totals.peak_position.z})
    if (!std::isfinite(value))
      throw InputError(names::kContactForceMap, "whole, regions", "must be finite");
}

}  // namespace

void requirePosition(const geometry_msgs::Point& position, const std::string& topic, const std::string& key)
{
  for (const double value : {position.x, position.y, position.z})
    if (!(std::abs(value) <= kFarthest))  // true for NaN
      throw InputError(topic, key, "must be finite positions within 1000 m of the origin");
}

void requireRadius(double radius, const std::string& topic, const std::string& key)
{
  if (!(radius >= 0.0 && radius <= kLargestRadius))
    throw InputError(topic, key, "must have finite radii of at most 1 m");
}

intervention::RoundBody roundBody(const std::vector<geometry_msgs::Point>& axis, const std::vector<double>& radius,
                                  const std::string& topic)
{
  if (axis.size() > kMostNodes)
    throw InputError(topic, "axis", "must be at most " + std::to_string(kMostNodes) + " points");
  intervention::RoundBody body;
  double length = 0.0;
  for (const geometry_msgs::Point& point : axis)
  {
    requirePosition(point, topic, "axis");
    body.axis.push_back(fromMessage(point));
    length += body.axis.size() > 1 ? (body.axis.back() - body.axis[body.axis.size() - 2]).norm() : 0.0;
  }
  for (const double value : radius)
    requireRadius(value, topic, "radius");
  if (!axis.empty() && !(length > 0.0 && length <= kLongestBody))
    throw InputError(topic, "axis", "must be longer than 0 and at most 2 m long");
  body.radii = radius;
  return body;
}

void requireUsable(const RodState& state, double largest_margin)
{
  const std::size_t nodes = state.nodes.size();
  requireSizes({state.radius.size(), state.margin.size()}, nodes, names::kRodState, "radius, margin", "nodes");
  if (state.first_node > kMostNodes)
    throw InputError(names::kRodState, "first_node", "must be at most " + std::to_string(kMostNodes));
  requireNodes(state.nodes, names::kRodState);
  requireWithin(state.radius, 0.0, kLargestRadius, names::kRodState, "radius");
  requireWithin(state.margin, 0.0, largest_margin, names::kRodState, "margin");
  requireWithin({state.wanted_free_distance}, 0.0, kLargestFreeDistance, names::kRodState, "wanted_free_distance");
}

void requireUsable(const RodStateVisual& state)
{
  requireNodes(state.nodes, names::kRodStateVisual);
  requireSizes({state.radius.size(), state.contact_force.size()}, state.nodes.size(), names::kRodStateVisual,
               "radius, contact_force", "nodes");
  requireWithin(state.radius, 0.0, kLargestRadius, names::kRodStateVisual, "radius");
  if (!std::isfinite(state.time) || !std::all_of(state.contact_force.begin(), state.contact_force.end(),
                                                 [](const auto& force) { return isFinite(force); }))
    throw InputError(names::kRodStateVisual, "time, contact_force", "must be finite");
}

void requireUsable(const RodStateVisual& state, std::size_t instruments)
{
  requireUsable(state);
  requireSizes({state.insertion.size(), state.rotation.size(), state.tip_rotation.size(), state.hand_force.size(),
                state.hand_torque.size(), state.pressure.size()},
               instruments, names::kRodStateVisual, "insertion to pressure", "instruments of the scene");
  for (const std::vector<double>* values : {&state.insertion, &state.rotation, &state.tip_rotation, &state.pressure})
    requireFinite(*values, names::kRodStateVisual, "insertion, rotation, tip_rotation, pressure");
}

void requireUsable(const DriveApplied& drive, std::size_t instruments)
{
  requireSizes({drive.insertion.size(), drive.rotation.size(), drive.pressure.size(), drive.hand_force.size(),
                drive.hand_torque.size()},
               instruments, names::kDriveApplied, "insertion to hand_torque", "instruments of the scene");
  for (const std::vector<double>* values : {&drive.insertion, &drive.rotation, &drive.pressure})
    requireFinite(*values, names::kDriveApplied, "insertion, rotation, pressure");
}

void requireUsable(const ContactForces& forces)
{
  for (const ContactForce& contact : forces.contacts)
  {
    requirePosition(contact.position, names::kContactForces, "position");
    if (!isFinite(contact.normal_force) || !isFinite(contact.friction_force))
      throw InputError(names::kContactForces, "normal_force, friction_force", "must be finite");
  }
}

void requireUsable(const ContactForceMap& map)
{
  requireSizes({map.triangle_regions.size(), map.peak.size(), map.peak_time.size(), map.integral.size(),
                map.time_over_threshold.size()},
               map.triangles.size(), names::kContactForceMap, "triangle_regions to time_over_threshold", "triangles");
  for (const std::vector<float>* values : {&map.peak, &map.peak_time, &map.integral, &map.time_over_threshold})
    requireFinite(*values, names::kContactForceMap, "peak to time_over_threshold");
  requireFinite(map.whole);
  for (const ContactForceTotals& region : map.regions)
    requireFinite(region);
  if (!std::isfinite(map.time) || !std::isfinite(map.threshold))
    throw InputError(names::kContactForceMap, "time, threshold", "must be finite");
}

void requireUsable(const sensor_msgs::Image& image)
{
  if (image.width == 0 || image.height == 0 || image.step < image.width ||
      image.data.size() != std::size_t{image.step} * image.height)
    throw InputError(names::kFluoroscopyImage, "width, height, step, data", "must be those of a complete image");
}

}  // namespace endovascular_sim::nodes
