#include "scene/facets_around.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/text/format.h"
#include "contact/wall/wall.h"

namespace endovascular_sim::scene
{
namespace
{

constexpr int kFewFacets = 384;       // around a wall of facets: mean torque of a soft J tip above 10 µN·m
constexpr int kFewFacetsSmooth = 12;  // around a smooth wall, before its refinement
constexpr double kFlat = 1e-3;        // rad
constexpr double kCap = 1.3;          // rad: rim of a cap
constexpr double kTenth = 0.9;

}  // namespace

FacetsAround facetsAround(const geometry::TriangleMesh& mesh)
{
  // Per vertex, the widest turn of the wall that is concave as seen from the lumen: that around the lumen.
  const contact::Wall wall(mesh);
  std::vector<double> turns;
  for (const std::vector<int>& edges : wall.vertex_edges)
  {
    double widest = 0.0;
    for (int e : edges)
      if (-wall.edges[e].reflex_angle < kCap)
        widest = std::max(widest, -wall.edges[e].reflex_angle);
    if (widest > kFlat)
      turns.push_back(widest);
  }
  FacetsAround around;
  if (turns.empty())
    return around;
  std::sort(turns.begin(), turns.end());
  const auto count = [&turns](double share)
  {
    const auto at = static_cast<std::size_t>(share * static_cast<double>(turns.size() - 1));
    return static_cast<int>(std::lround(2.0 * M_PI / turns[at]));
  };
  around.fewest = count(kTenth);
  around.median = count(0.5);
  return around;
}

std::string FacetsAround::text(contact::WallShape wall) const
{
  if (fewest == 0)
    return "facets around the lumen: unknown";
  std::string result =
      formatted("facets around the lumen: %d (median), at least %d in nine tenths of the wall", median, fewest);
  const bool smooth = wall == contact::WallShape::kSmooth;
  if (!smooth && fewest < kFewFacets)
    result += "; facets disturb force and torque at the hand below " + std::to_string(kFewFacets) +
              ", which vessel.wall: smooth avoids";
  if (smooth && fewest < kFewFacetsSmooth)
    result += "; the shape between so few facets is a guess; the smooth wall is refined from them";
  return result;
}

}  // namespace endovascular_sim::scene
