#include "intervention/wall_displacement.h"

namespace endovascular_sim::intervention
{

WallDisplacement displacementBetween(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to)
{
  WallDisplacement displacement;
  for (std::size_t v = 0; v < from.size(); ++v)
    if (to[v] != from[v])
    {
      displacement.indices.push_back(static_cast<int>(v));
      displacement.positions.push_back(to[v]);
    }
  return displacement;
}

void move(const WallDisplacement& displacement, std::vector<Eigen::Vector3d>& vertices)
{
  for (std::size_t k = 0; k < displacement.indices.size(); ++k)
    vertices[static_cast<std::size_t>(displacement.indices[k])] = displacement.positions[k];
}

}  // namespace endovascular_sim::intervention
