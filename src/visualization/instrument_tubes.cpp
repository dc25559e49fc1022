#include "visualization/instrument_tubes.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::visualization
{
namespace
{

/** Arc length from each node to the last one [m]. */
std::vector<double> distancesToTip(const std::vector<Eigen::Vector3d>& nodes)
{
  std::vector<double> distances(nodes.size(), 0.0);
  for (std::size_t i = nodes.size() - 1; i > 0; --i)
    distances[i - 1] = distances[i] + (nodes[i] - nodes[i - 1]).norm();
  return distances;
}

bool allFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/** Data of one call of instrumentAxes(). */
struct Stack
{
  const WireState& state;
  const std::vector<InstrumentShape>& shapes;
  const WireStyle& style;
  std::vector<double> to_tip;  ///< arc length from each node to the foremost tip [m]
  std::vector<double> behind;  ///< arc length from the tip of each instrument to the foremost one [m]

  bool isOutermost(std::size_t instrument, double at) const
  {
    for (std::size_t k = instrument + 1; k < behind.size(); ++k)
      if (behind[k] <= at)
        return false;
    return true;
  }

  bool holdsAnother(std::size_t instrument, double at) const
  {
    if (!shapes[instrument].is_hollow)
      return false;
    for (std::size_t k = 0; k < instrument; ++k)
      if (behind[k] <= at)
        return true;
    return false;
  }
};

/** Appends the point of an instrument at a distance from the foremost tip. */
void addPoint(const Stack& stack, std::size_t instrument, std::size_t node, double share, TubeAxis& axis)
{
  const WireState& state = stack.state;
  const std::size_t next = std::min(node + 1, state.nodes.size() - 1);
  const double at = stack.to_tip[node] + share * (stack.to_tip[next] - stack.to_tip[node]);
  const Eigen::Vector3d point = state.nodes[node] + share * (state.nodes[next] - state.nodes[node]);
  double radius = stack.shapes[instrument].radiusAt(std::max(at - stack.behind[instrument], 0.0));
  const Colour base = stack.style.colours.empty() ? Colour{0.75F, 0.78F, 0.82F}
                                                  : stack.style.colours[instrument % stack.style.colours.size()];
  TranslucentColour colour{base, 1.0F};
  if (stack.isOutermost(instrument, at))
  {
    radius = std::max(radius, state.radii[node]);
    if (stack.style.shows_forces && !state.forces.empty())
      colour.colour = forceColourOver(base, state.forces[node], stack.style.full_force);
  }
  if (stack.holdsAnother(instrument, at))
    colour.opacity = stack.style.opacity_over_another;
  const double outer = std::max(state.radii[node], 1e-6);
  axis.add(point, std::max(stack.style.radius_scale, stack.style.smallest_radius / outer) * radius, colour);
}

}  // namespace

double InstrumentShape::radiusAt(double from_tip) const
{
  const std::size_t sections = std::min(ends.size(), outer_radii.size());
  if (sections == 0)
    return 0.0;
  const auto section = static_cast<std::size_t>(
      std::lower_bound(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(sections), from_tip) - ends.begin());
  return outer_radii[std::min(section, sections - 1)];
}

const char* problemOfWire(const WireState& state, const std::vector<InstrumentShape>& shapes)
{
  if (const char* problem = problemOfTube(state.nodes, state.radii))
    return problem;
  if (!state.forces.empty() && state.forces.size() != state.nodes.size())
    return "inconsistent lengths";
  if (!shapes.empty() && state.insertions.size() != shapes.size())
    return "insertions do not match the instruments of the scene";
  if (!allFinite(state.forces) || !allFinite(state.insertions))
    return "not finite";
  return nullptr;
}

void instrumentAxes(const WireState& state, const std::vector<InstrumentShape>& shapes, const WireStyle& style,
                    std::vector<TubeAxis>& axes)
{
  static const std::vector<InstrumentShape> kOneInstrument{InstrumentShape{}};
  const bool has_shapes = !shapes.empty();
  Stack stack{state, has_shapes ? shapes : kOneInstrument, style, distancesToTip(state.nodes), {}};
  if (has_shapes)
  {
    const double furthest = *std::max_element(state.insertions.begin(), state.insertions.end());
    for (const double insertion : state.insertions)
      stack.behind.push_back(furthest - insertion);
  }
  else
    stack.behind.push_back(0.0);

  axes.resize(stack.shapes.size());
  for (std::size_t instrument = 0; instrument < axes.size(); ++instrument)
  {
    TubeAxis& axis = axes[instrument];
    axis.clear();
    for (std::size_t node = 0; node < state.nodes.size(); ++node)
    {
      if (stack.to_tip[node] < stack.behind[instrument])
        break;
      addPoint(stack, instrument, node, 0.0, axis);
      const bool tip_follows = node + 1 < state.nodes.size() && stack.to_tip[node + 1] < stack.behind[instrument];
      if (tip_follows)
        addPoint(stack, instrument, node,
                 (stack.to_tip[node] - stack.behind[instrument]) / (stack.to_tip[node] - stack.to_tip[node + 1]), axis);
    }
  }
}

Colour forceColourOver(const Colour& base, double force, double full_force)
{
  if (!(full_force > 0.0) || !std::isfinite(force))
    return base;
  const double third = full_force / 3.0;  // the colours of force begin with yellow at one third
  if (force >= third)
    return forceColour(force, full_force);
  return blend(base, forceColour(third, full_force), static_cast<float>(std::max(force, 0.0) / third));
}

}  // namespace endovascular_sim::visualization
