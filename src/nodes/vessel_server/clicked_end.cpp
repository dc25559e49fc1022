#include "nodes/vessel_server/clicked_end.h"

#include <algorithm>
#include <vector>

#include "common/text/format.h"

namespace endovascular_sim::nodes
{
namespace
{

std::string coordinates(const Eigen::Vector3d& position)
{
  constexpr double kResolution = 1e-5;                                                     // m
  const Eigen::Vector3d p = kResolution * (position / kResolution).array().round() + 0.0;  // without negative zeros
  return formatted("%.5f,%.5f,%.5f", p.x(), p.y(), p.z());
}

}  // namespace

std::string clickedEndText(const vessel::CentrelineTree& tree, const scene::VesselScene& scene,
                           const Eigen::Vector3d& point)
{
  const std::vector<vessel::CentrelineEnd> ends = vessel::centrelineEnds(tree);
  if (ends.empty() || !point.allFinite())
    return "clicked point: the vessel has no end there";
  const vessel::CentrelineEnd& end =
      *std::min_element(ends.begin(), ends.end(),
                        [&point](const vessel::CentrelineEnd& a, const vessel::CentrelineEnd& b)
                        { return (a.position - point).norm() < (b.position - point).norm(); });
  const std::string distances = formatted(", %.1f mm from the click, radius of the lumen %.1f mm.",
                                          1e3 * (end.position - point).norm(), 1e3 * end.radius);
  std::string text =
      "clicked point: nearest is the end of " + tree.branches[static_cast<std::size_t>(end.branch)].name + distances;
  if (!scene.mesh.empty())
  {
    const std::string at = coordinates(scene.transform.inverse() * end.position);
    text += "\n  open it: vessel_prepare or vessel_segment --open " + at +
            "\n  keep it closed: vessel_segment --closed " + at;
  }
  return text + "\n  enter there: simulate --set entry.position=[" + coordinates(end.position) +
         "] --set entry.nearest_centreline_end=true";
}

}  // namespace endovascular_sim::nodes
