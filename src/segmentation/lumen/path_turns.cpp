#include "segmentation/lumen/path_turns.h"

#include <algorithm>

namespace endovascular_sim::segmentation
{

std::vector<Stretch> turnsOf(const LumenBranch& branch)
{
  const std::vector<double> arc = branch.arc();
  std::vector<Stretch> found;
  bool is_open = false;
  for (std::size_t k = 1; k + 1 < arc.size(); ++k)
  {
    const Eigen::Vector3d before = (branch.sections[k].centre - branch.sections[k - 1].centre).normalized();
    const Eigen::Vector3d after = (branch.sections[k + 1].centre - branch.sections[k].centre).normalized();
    const double curvature = 2.0 * (after - before).norm() / (arc[k + 1] - arc[k - 1]);
    const double diameter = branch.sections[k].diameter();
    const bool is_end = std::min(arc[k], arc.back() - arc[k]) < kEnds * diameter;
    const bool turns = !is_end && curvature * kTightestBend * 0.5 * diameter > 1.0;
    if (turns && !is_open)
      found.push_back({arc[k], arc[k]});
    else if (turns)
      found.back().to = arc[k];
    is_open = turns;
  }
  return found;
}

}  // namespace endovascular_sim::segmentation
