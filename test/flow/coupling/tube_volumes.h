#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "contrast/cells/contrast_cells.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::flow
{

/** Volumes of contrast cells as tubes around the centreline [m³]. */
inline std::vector<double> tubeVolumes(const contrast::ContrastCells& cells, const vessel::CentrelineTree& centreline)
{
  constexpr double kPi = 3.14159265358979323846;
  constexpr int kSamples = 20;
  std::vector<double> volumes;
  for (const contrast::ContrastCell& cell : cells)
  {
    const vessel::CentrelineBranch& branch = centreline.branches[static_cast<std::size_t>(cell.branch)];
    double volume = 0.0, arc = 0.0;
    std::size_t k = 1;
    double step = (branch.points[1] - branch.points[0]).norm();
    for (int sample = 0; sample < kSamples; ++sample)
    {
      const double at = cell.begin + (cell.end - cell.begin) * (sample + 0.5) / kSamples;
      while (arc + step < at && k + 1 < branch.points.size())
      {
        arc += step;
        ++k;
        step = (branch.points[k] - branch.points[k - 1]).norm();
      }
      const double share = step > 0.0 ? std::clamp((at - arc) / step, 0.0, 1.0) : 0.0;
      const double radius = branch.radii[k - 1] + share * (branch.radii[k] - branch.radii[k - 1]);
      volume += kPi * radius * radius * (cell.end - cell.begin) / kSamples;
    }
    volumes.push_back(volume);
  }
  return volumes;
}

}  // namespace endovascular_sim::flow
