#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "segmentation/segment_vessel.h"
#include "test/segmentation/lumen_scan.h"

namespace endovascular_sim::segmentation
{

/** Y of three lumens of 8 mm [mm]. */
class ForkedVessel : public testing::Test
{
protected:
  static const Scan& scan()
  {
    static const Scan made(scanOfLumens({-26, -8, -2}, {26, 8, 66}, 0.8,
                                        {tubeAlong({{0, 0, -4}, {0, 0, 30}, {-18, 0, 70}}, 4.0),
                                         tubeAlong({{0, 0, 28}, {0, 0, 30}, {18, 0, 70}}, 4.0)}));
    return made;
  }

  static EdgeSettings settings() { return edgeSettings(scan().modality(), scan().spacing()); }

  static Segmentation segmented(const std::vector<Eigen::Vector3d>& clicks)
  {
    return segmentBranches(scan(), clicksInto({{"vessel", clicks}}), settings(), 1);
  }
};

inline bool holds(const std::vector<std::string>& texts, const std::string& part)
{
  return std::any_of(texts.begin(), texts.end(),
                     [&part](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace endovascular_sim::segmentation
