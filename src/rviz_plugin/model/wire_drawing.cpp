#include "rviz_plugin/model/wire_drawing.h"

#include <algorithm>

#include "rviz_plugin/model/message_points.h"
#include "visualization/wire_refinement.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr std::size_t kMostNodes = 20000;  ///< a message with more is no wire
constexpr double kLargestTurn = 0.06;      ///< angle between drawn segments [rad]

}  // namespace

std::string WireDrawing::update(const RodStateVisual& message, const visualization::WireStyle& style)
{
  clear();
  std::string problem = read(message);
  if (!problem.empty())
    return problem;
  if (message.time < last_time_)  // reset of the simulation, or jump of a recording
    restartScale(largest_before_);
  last_time_ = message.time;
  largest_force_ = state_.forces.empty() ? 0.0 : *std::max_element(state_.forces.begin(), state_.forces.end());
  scale_.follow(largest_force_);
  visualization::WireStyle scaled = style;
  if (!(scaled.full_force > 0.0))
    scaled.full_force = scale_.full();
  full_force_ = scaled.full_force;
  visualization::refineWire(state_, kLargestTurn, refined_);
  visualization::instrumentAxes(refined_, shapes_, scaled, axes_);
  for (const visualization::TubeAxis& axis : axes_)
    builder_.append(axis, surface_);
  divideTriangles();
  return {};
}

void WireDrawing::divideTriangles()
{
  for (std::size_t i = 0; i + 2 < surface_.triangles.size(); i += 3)
  {
    const auto corner = surface_.triangles.begin() + static_cast<std::ptrdiff_t>(i);
    const bool is_opaque =
        std::all_of(corner, corner + 3, [&](std::uint32_t v) { return surface_.colours[v].opacity >= 1.0F; });
    std::vector<std::uint32_t>& list = is_opaque ? opaque_ : translucent_;
    list.insert(list.end(), corner, corner + 3);
  }
}

void WireDrawing::restartScale(double largest)
{
  largest_before_ = largest;
  scale_.reset();
  scale_.follow(largest);
}

void WireDrawing::clear()
{
  surface_.clear();
  opaque_.clear();
  translucent_.clear();
}

std::string WireDrawing::read(const RodStateVisual& message)
{
  if (message.nodes.size() > kMostNodes)
    return "more than " + std::to_string(kMostNodes) + " nodes";
  toEigen(message.nodes, state_.nodes);
  state_.radii.assign(message.radius.begin(), message.radius.end());
  state_.forces.clear();
  for (const geometry_msgs::Vector3& force : message.contact_force)
    state_.forces.push_back(toEigen(force).norm());
  state_.insertions.assign(message.insertion.begin(), message.insertion.end());
  // Instruments of another scene: one tube until the scene of this one arrives.
  if (!shapes_.empty() && state_.insertions.size() != shapes_.size())
    shapes_.clear();
  const char* problem = visualization::problemOfWire(state_, shapes_);
  return problem == nullptr ? std::string() : std::string(problem);
}

}  // namespace endovascular_sim::rviz_plugin
