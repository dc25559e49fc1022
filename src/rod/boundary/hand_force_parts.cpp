#include "rod/boundary/hand_force_parts.h"

#include <algorithm>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kSharpest = 0.05;  // lower bound of 1 + cos: at a fold w would be infinite

}  // namespace

void slideAlongItself(const std::vector<Eigen::Vector3d>& position, const std::vector<Eigen::Vector3d>& motion,
                      int first, int held, const Eigen::Vector3d& direction, std::vector<Eigen::Vector3d>& slide)
{
  const int n = static_cast<int>(position.size());
  slide.resize(position.size());
  Eigen::Vector3d before = direction;
  double scale = 1.0;  // so that the first free edge keeps its length too
  for (int i = first; i < n; ++i)
  {
    Eigen::Vector3d after = before;
    if (i + 1 < n)
      after = (position[i + 1] - motion[i + 1] - position[i] + motion[i]).normalized();
    if (i == first && held < first)
      before = after;
    if (i == held)
      scale = after.dot(direction);
    slide[i] = i <= held ? direction
                         : Eigen::Vector3d((scale / std::max(kSharpest, 1.0 + before.dot(after))) * (before + after));
    before = after;
  }
}

}  // namespace endovascular_sim::rod
