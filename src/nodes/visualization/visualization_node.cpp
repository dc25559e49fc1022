#include "nodes/visualization/visualization_node.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <regex>
#include <sstream>

#include <std_msgs/ColorRGBA.h>

#include "intervention/stent_placement.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/parameters.h"
#include "nodes/runtime/ros_names.h"
#include "visualization/force_colour.h"
#include "visualization/tube_surface.h"
#include "visualization/wall_surface.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kMarkerRate = 30.0;          ///< [Hz]; rviz stutters with more
constexpr double kMovedRate = 15.0;           ///< of the moved vessel [Hz]
constexpr int kTubeSides = 8;                 ///< corners of the drawn cross-section of the wire
constexpr std::size_t kTipPathPoints = 2000;  ///< capacity of the path; the oldest points are dropped
constexpr double kTipPathSpacing = 0.25e-3;   ///< distance between two points of the path [m]
constexpr double kTipPathWidth = 0.6e-3;      ///< width of the drawn path [m]
constexpr int kBalloonSides = 24;             ///< corners of the drawn cross-section of a balloon
constexpr double kStrutWidth = 0.12e-3;       ///< width of drawn struts [m]
constexpr double kLegendHeight = 12e-3;       ///< of the letters of the legend, and its distance from the vessel [m]
constexpr double kHeatRadius = 2e-3;          ///< distance over which the colour of a touched triangle fades [m]
constexpr double kHeatInset = 0.1e-3;         ///< distance of the coloured triangles from the wall, into the lumen [m]

/** Points of the triangles of a surface. */
std::vector<geometry_msgs::Point> pointsOf(const visualization::Surface& surface)
{
  std::vector<geometry_msgs::Point> points;
  points.reserve(surface.triangles.size());
  for (const std::uint32_t vertex : surface.triangles)
    points.push_back(toPoint(surface.positions[vertex].cast<double>()));
  return points;
}

/** Marker with a fixed namespace and id: every message replaces the last one. */
visualization_msgs::Marker marker(const std_msgs::Header& header, const char* name, int type)
{
  visualization_msgs::Marker result;
  result.header = header;
  result.ns = name;
  result.id = 0;
  result.type = type;
  result.action = visualization_msgs::Marker::ADD;
  result.pose.orientation.w = 1.0;
  result.scale.x = result.scale.y = result.scale.z = 1.0;
  result.color.a = 1.0F;
  return result;
}

std_msgs::ColorRGBA toMessage(const visualization::TranslucentColour& colour)
{
  std_msgs::ColorRGBA result;
  result.r = colour.colour.red;
  result.g = colour.colour.green;
  result.b = colour.colour.blue;
  result.a = colour.opacity;
  return result;
}

/** Full scale of a parameter; 0: it follows the largest value. */
double fullScale(const ros::NodeHandle& parameters, const std::string& name, const Quantity& quantity)
{
  return parameters.param(name, 0.0) == 0.0 ? 0.0 : numericParameter(parameters, name, 0.0, quantity);
}

/** Body of the resting patient in the moved one; its radii do not change. */
intervention::RoundBody moved(intervention::RoundBody body, const motion::MotionMap& map)
{
  std::vector<Eigen::Vector3d> axis;
  map.positions(body.axis, axis);
  body.axis.swap(axis);
  return body;
}

/** Publishes a marker; an empty one as a deletion, since rviz rejects empty lists. */
void publishOrDelete(visualization_msgs::Marker& marker, const ros::Publisher& publisher)
{
  if (marker.points.empty())
    marker.action = visualization_msgs::Marker::DELETE;
  publisher.publish(marker);
}

}  // namespace

VisualizationNode::VisualizationNode(ros::NodeHandle node, const ros::NodeHandle& parameters)
  : node_(node),
    full_scale_(fullScale(parameters, "force_full_scale", quantities::kWallForce)),
    radius_scale_(numericParameter(parameters, "radius_scale", 1.5, quantities::kScale)),
    heat_of_(parameters.param<std::string>("heat_of", "peak")),
    heat_full_scale_(fullScale(parameters, "heat_full_scale", quantities::kHeatScale)),
    wire_publisher_(node.advertise<visualization_msgs::Marker>(names::kWireMarker, 1, true)),
    tip_path_publisher_(node.advertise<visualization_msgs::Marker>(names::kTipPathMarker, 1, true)),
    balloon_publisher_(node.advertise<visualization_msgs::Marker>(names::kBalloonMarker, 1, true)),
    stent_publisher_(node.advertise<visualization_msgs::Marker>(names::kStentMarker, 1, true)),
    heat_publisher_(node.advertise<visualization_msgs::Marker>(names::kContactForceMarker, 1, true)),
    legend_publisher_(node.advertise<visualization_msgs::Marker>(names::kForceLegendMarker, 1, true))
{
  if (heat_of_ != "peak" && heat_of_ != "integral" && heat_of_ != "time_over_threshold")
  {
    ROS_WARN("~heat_of is '%s'; must be peak, integral or time_over_threshold: using peak", heat_of_.c_str());
    heat_of_ = "peak";
  }
  if (parameters.param("draw_vessel", false))
    vessel_publisher_ = node.advertise<visualization_msgs::Marker>(names::kVesselMarker, 1, true);
  rod_subscriber_ = subscribeGuarded<RodStateVisual>(node, names::kRodStateVisual, 2,
                                                     [this](const RodStateVisual& state) { drawWire(state); });
  vessel_subscriber_ = subscribeGuarded<VesselMesh>(node, names::kVesselMesh, 1,
                                                    [this](const VesselMesh& vessel) { receiveVessel(vessel); });
  treatment_subscriber_ = subscribeGuarded<TreatmentVisual>(
      node, names::kTreatmentVisual, 2, [this](const TreatmentVisual& message) { receiveTreatment(message); });
  player_subscriber_ = subscribeGuarded<PlayerState>(node, names::kPlayerState, 1,
                                                     [this](const PlayerState& player) { receivePlayer(player); });
  motion_subscriber_ = subscribeGuarded<MotionState>(node, names::kMotionState, MotionHistory::kCapacity,
                                                     [this](const MotionState& message) { receiveMotion(message); });
  force_map_subscriber_ = subscribeGuarded<ContactForceMap>(
      node, names::kContactForceMap, 1, [this](const ContactForceMapConstPtr& map) { receiveForceMap(map); });
}

void VisualizationNode::drawWire(const RodStateVisual& state)
{
  requireUsable(state);
  if (state.time < last_time_)
  {
    // The session or the replay was restarted.
    path_.clear();
    force_scale_.reset();
    force_scale_.follow(largest_before_);
    heat_scale_.reset();
  }
  else if (state.time - last_time_ < 1.0 / kMarkerRate - 1e-4)
    return;
  last_time_ = state.time;
  if (state.nodes.empty())
    return;

  const std::vector<visualization::Colour> colours = nodeColours(state);
  visualization::TubeAxis axis;
  for (std::size_t i = 0; i < state.nodes.size(); ++i)
    axis.add(fromMessage(state.nodes[i]), radius_scale_ * state.radius[i], {colours[i], 1.0F});
  visualization::Surface surface;
  visualization::TubeBuilder(kTubeSides).append(axis, surface);
  visualization_msgs::Marker tube = marker(state.header, "wire", visualization_msgs::Marker::TRIANGLE_LIST);
  tube.points = pointsOf(surface);
  if (!heat_)
    legend_place_ = state.nodes.front();
  drawLegend(state.header);
  tube.colors.reserve(tube.points.size());
  for (const std::uint32_t vertex : surface.triangles)
    tube.colors.push_back(toMessage(surface.colours[vertex]));
  // rviz rejects empty triangle lists: no marker before the first edge.
  if (!tube.points.empty())
    wire_publisher_.publish(tube);
  followTip(state.header, motions_.nearest(state.step).pullBack(axis.points.back()));
}

void VisualizationNode::receivePlayer(const PlayerState& player)
{
  if (player.jumps != jumps_)
    path_.clear();
  jumps_ = player.jumps;
  largest_before_ = player.peak_node_force;
  force_scale_.follow(largest_before_);
}

std::vector<visualization::Colour> VisualizationNode::nodeColours(const RodStateVisual& state)
{
  std::vector<double> forces(state.nodes.size(), 0.0);
  for (std::size_t i = 0; i < std::min(forces.size(), state.contact_force.size()); ++i)
    forces[i] = std::hypot(state.contact_force[i].x, state.contact_force[i].y, state.contact_force[i].z);
  force_scale_.follow(*std::max_element(forces.begin(), forces.end()));
  std::vector<visualization::Colour> colours;
  colours.reserve(forces.size());
  for (const double force : forces)
    colours.push_back(visualization::forceColour(force, forceScale()));
  return colours;
}

void VisualizationNode::drawLegend(const std_msgs::Header& header)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "red: " << forceScale() << " N on the wire";
  if (heat_)
    text << ", " << heatScale()
         << (heat_of_ == "peak"       ? " N"
             : heat_of_ == "integral" ? " N s"
                                      : " s")
         << " on the wall (" << std::regex_replace(heat_of_, std::regex("_"), " ") << ")";
  if (text.str() == legend_)
    return;
  legend_ = text.str();
  visualization_msgs::Marker legend = marker(header, "legend", visualization_msgs::Marker::TEXT_VIEW_FACING);
  legend.pose.position = legend_place_;
  legend.scale.z = kLegendHeight;
  legend.color.r = legend.color.g = legend.color.b = 0.95F;
  legend.text = legend_;
  legend_publisher_.publish(legend);
}

void VisualizationNode::followTip(const std_msgs::Header& header, const Eigen::Vector3d& tip)
{
  if (!path_.empty() && (path_.back() - tip).norm() < kTipPathSpacing)
    return;
  path_.push_back(tip);
  if (path_.size() > kTipPathPoints)
    path_.pop_front();
  drawTipPath(header);
}

void VisualizationNode::drawTipPath(const std_msgs::Header& header)
{
  if (path_.size() < 2)
    return;
  visualization_msgs::Marker line = marker(header, "tip_path", visualization_msgs::Marker::LINE_STRIP);
  line.scale.x = kTipPathWidth;
  line.color.r = 0.25F;
  line.color.g = 0.65F;
  line.color.b = 1.0F;
  line.color.a = 0.8F;
  for (const Eigen::Vector3d& point : path_)
    line.points.push_back(toPoint(map_.position(point)));
  tip_path_publisher_.publish(line);
}

void VisualizationNode::receiveVessel(const VesselMesh& vessel)
{
  wall_ = fromMessage(vessel);
  heat_ = std::make_unique<visualization::WallHeatMap>(wall_, kHeatRadius, kHeatInset);
  if (vessel.version == 1 || vessel_hash_ == 0)
    vessel_hash_ = vessel.content_hash;  // maps contain the hash of the initial wall
  geometry_msgs::Point low, high;
  for (const geometry_msgs::Point& vertex : vessel.mesh.vertices)
  {
    const bool is_first = &vertex == &vessel.mesh.vertices.front();
    low.x = is_first ? vertex.x : std::min(low.x, vertex.x);
    high.x = is_first ? vertex.x : std::max(high.x, vertex.x);
    high.z = is_first ? vertex.z : std::max(high.z, vertex.z);
  }
  legend_place_ = high;
  legend_place_.x = 0.5 * (low.x + high.x);
  legend_place_.z += 2.0 * kLegendHeight;
  legend_.clear();
  if (newest_map_)
    drawHeatMap(*newest_map_);  // it arrived before the vessel
  if (vessel_publisher_)
    drawVessel(vessel.header);
}

void VisualizationNode::receiveMotion(const MotionState& message)
{
  motions_.add(message);
  if (std::abs(message.time - last_moved_) < 1.0 / kMovedRate - 1e-4)
    return;
  last_moved_ = message.time;
  const bool stays = map_.resting() && motions_.newest().map.resting();
  map_ = motions_.newest().map;
  if (stays)
    return;
  std_msgs::Header header;
  header.stamp = message.header.stamp;
  header.frame_id = names::kPatientFrame;
  if (!vessel_publisher_)
    vessel_publisher_ = node_.advertise<visualization_msgs::Marker>(names::kVesselMarker, 1, true);
  if (vessel_publisher_.getNumSubscribers() > 0)
    drawVessel(header);
  heat_marker_.header = header;
  if (heat_publisher_.getNumSubscribers() > 0 && !heat_patch_.corners.empty())
    publishHeatMap();
  if (tip_path_publisher_.getNumSubscribers() > 0)
    drawTipPath(header);
}

void VisualizationNode::receiveTreatment(const TreatmentVisual& message)
{
  if (std::abs(message.time - last_treatment_) < 1.0 / kMarkerRate - 1e-4)
    return;
  drawBalloons(message);
  drawStents(message);
  last_treatment_ = message.time;
}

void VisualizationNode::drawBalloons(const TreatmentVisual& message)
{
  visualization_msgs::Marker balloons = marker(message.header, "balloon", visualization_msgs::Marker::TRIANGLE_LIST);
  balloons.color.r = 0.95F;
  balloons.color.g = 0.9F;
  balloons.color.b = 0.6F;
  balloons.color.a = 0.5F;
  visualization::TubeBuilder builder(kBalloonSides);
  visualization::Surface surface;
  const motion::MotionMap map = motions_.nearest(message.step);
  for (const TreatmentBody& body : message.balloons)
  {
    const intervention::RoundBody balloon = moved(fromMessage(body), map);
    builder.append({balloon.axis, balloon.radii, std::vector<visualization::TranslucentColour>(balloon.axis.size())},
                   surface);
  }
  balloons.points = pointsOf(surface);
  publishOrDelete(balloons, balloon_publisher_);
}

void VisualizationNode::drawStents(const TreatmentVisual& message)
{
  visualization_msgs::Marker stents = marker(message.header, "stent", visualization_msgs::Marker::LINE_LIST);
  stents.color.r = stents.color.g = stents.color.b = 0.75F;
  stents.scale.x = kStrutWidth;
  const motion::MotionMap map = motions_.nearest(message.step);
  for (const TreatmentBody& body : message.stents)
    for (const std::vector<Eigen::Vector3d>& ring : intervention::stentStruts(moved(fromMessage(body), map)))
      for (std::size_t k = 0; k + 1 < ring.size(); ++k)
      {
        stents.points.push_back(toPoint(ring[k]));
        stents.points.push_back(toPoint(ring[k + 1]));
      }
  publishOrDelete(stents, stent_publisher_);
}

void VisualizationNode::receiveForceMap(const ContactForceMapConstPtr& map)
{
  requireUsable(*map);
  newest_map_ = map;
  if (heat_)
    drawHeatMap(*map);
}

void VisualizationNode::drawHeatMap(const ContactForceMap& map)
{
  if (map.content_hash != vessel_hash_)
    return;
  const bool of_peak = heat_of_ == "peak";
  heat_patch_ = heat_->patch(map.triangles, of_peak                  ? map.peak
                                            : heat_of_ == "integral" ? map.integral
                                                                     : map.time_over_threshold);
  const std::vector<double>& values = heat_patch_.values;
  if (!values.empty())
    heat_scale_.follow(*std::max_element(values.begin(), values.end()));
  heat_marker_ = marker(map.header, "wall_forces", visualization_msgs::Marker::TRIANGLE_LIST);
  for (const double value : values)
    heat_marker_.colors.push_back(toMessage(visualization::heatColour(value, heatScale())));
  publishHeatMap();
  drawLegend(map.header);
}

void VisualizationNode::publishHeatMap()
{
  visualization_msgs::Marker heat = heat_marker_;
  for (const Eigen::Vector3d& corner : heat_patch_.corners)
    heat.points.push_back(toPoint(map_.position(corner)));
  publishOrDelete(heat, heat_publisher_);
}

void VisualizationNode::drawVessel(const std_msgs::Header& header)
{
  visualization_msgs::Marker wall = marker(header, "vessel", visualization_msgs::Marker::TRIANGLE_LIST);
  wall.color.r = 1.0F;
  wall.color.g = 0.55F;
  wall.color.b = 0.5F;
  wall.color.a = 0.35F;
  std::vector<Eigen::Vector3d> vertices;
  map_.positions(wall_.vertices, vertices);
  wall.points.reserve(3 * wall_.triangles.size());
  for (const Eigen::Vector3i& triangle : wall_.triangles)
    for (int corner = 0; corner < 3; ++corner)
      wall.points.push_back(toPoint(vertices[static_cast<std::size_t>(triangle[corner])]));
  if (!wall.points.empty())
    vessel_publisher_.publish(wall);
}

}  // namespace endovascular_sim::nodes
