#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/contract/contact_set.h"
#include "rod/model/discretisation.h"

namespace endovascular_sim::rod
{

/** Depth up to which a soft wall yields by its stiffness: max(r/2, r − 0.1 mm); beyond it, the wall is rigid [m]. The
 *  wire's axis stays in the undeformed lumen. @param radius radius of the wire [m] */
double softWallTravel(double radius);

/** Radius of the wire without balloons at a contact [m]. */
inline double wireRadiusAt(const contact::Feature& feature, const Discretisation& rod)
{
  const double first = rod.radius[feature.edge];
  const double second = rod.radius[std::min(feature.edge + 1, rod.nodes() - 1)];
  return first == second ? first : (1.0 - feature.parameter) * first + feature.parameter * second;
}

/** True for a stiff layer, false for a feature of the wall. */
inline bool isStiffLayer(const contact::Feature& feature)
{
  return feature.id < 0;
}

/** Depth of a feature's stiff layer behind the wall's surface [m]: 40 µm behind a rigid wall, whose spring would
 *  otherwise yield by force over stiffness without limit, and softWallTravel behind a soft wall. */
double stiffLayerDepth(const contact::Feature& feature, const Discretisation& rod);

/** Appends a second feature behind the wall for every feature whose stiff layer may be reached in a solve. A rigid
 *  wall's layer is needed only where its spring is already pressed in by half of the layer's depth.
 *  @param reach function of a node: largest motion in a solve [m] */
template <typename Reach>
void addStiffLayer(const Discretisation& rod, const Reach& reach, std::vector<contact::Feature>& features)
{
  const std::size_t count = features.size();
  for (std::size_t f = 0; f < count; ++f)
  {
    contact::Feature layer = features[f];
    const bool soft = std::isfinite(layer.stiffness);
    const double depth = stiffLayerDepth(layer, rod);
    layer.gap += depth;
    const int next = std::min(layer.edge + 1, rod.nodes() - 1);
    if (layer.gap > (soft ? std::max(reach(layer.edge), reach(next)) : 0.5 * depth))
      continue;
    layer.id = -1 - layer.id;
    features.push_back(layer);
  }
}

/** Removes all stiff layers. */
void removeStiffLayer(std::vector<contact::Feature>& features);

}  // namespace endovascular_sim::rod
