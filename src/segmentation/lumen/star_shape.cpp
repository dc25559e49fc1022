#include "segmentation/lumen/star_shape.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kWide = 8e-3;      ///< least diameter of a lumen that is looked at [m]
constexpr double kGrazing = 0.27;   ///< tangent of the angle between ray and contour, below which a ray grazes it
constexpr int kNarrowestBulge = 4;  ///< rays
constexpr int kWidestBulge = 36;    ///< rays: more are the vessel, and the others a side branch
constexpr double kShortest = 3e-3;  ///< of a stretch [m]

}  // namespace

bool hidesLumen(const Section& section)
{
  const double jump = 2.0 * M_PI / kRays / kGrazing;
  const auto at = [&section](int ray) { return section.radii[static_cast<std::size_t>((ray + kRays) % kRays)]; };
  const auto isEdge = [&section](int ray)
  {
    const RayEnd end = section.ends[static_cast<std::size_t>((ray + kRays) % kRays)];
    return end == RayEnd::kWall || end == RayEnd::kCalcium || end == RayEnd::kBone;
  };
  for (int begin = 0; begin < kRays; ++begin)
  {
    if (at(begin - 1) - at(begin) < jump * at(begin))
      continue;
    int edges = 0;
    for (int width = 1; width <= kWidestBulge; ++width)
    {
      edges += isEdge(begin + width - 1) ? 1 : 0;
      if (width >= kNarrowestBulge && 2 * edges > width &&
          at(begin + width) - at(begin + width - 1) > jump * at(begin + width - 1))
        return true;
    }
  }
  return false;
}

std::optional<Stretch> hiddenStretch(const LumenBranch& branch)
{
  const std::vector<double> arc = branch.arc();
  std::optional<Stretch> stretch;
  for (std::size_t k = 0; k < arc.size(); ++k)
  {
    if (branch.sections[k].diameter() < kWide || !hidesLumen(branch.sections[k]))
    {
      stretch.reset();
      continue;
    }
    if (!stretch)
      stretch = Stretch{arc[k], arc[k]};
    stretch->to = arc[k];
    if (stretch->to - stretch->from >= kShortest)
      return stretch;
  }
  return std::nullopt;
}

}  // namespace endovascular_sim::segmentation
