#pragma once

#include <cstdint>
#include <vector>

#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Greyscale picture in row-major order from the top. */
struct GreyPicture
{
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/** Straightened view of a branch: two perpendicular cuts along its centreline, one above the other, with the contour as
 * a white line. The branch begins on the left. Marks above and below are 10 mm apart. */
GreyPicture straightenedView(const Scan& scan, const LumenBranch& branch);

/** Range of values that pictures show: black and white. */
struct GreyWindow
{
  double black = 0.0;
  double white = 0.0;

  std::uint8_t grey(double value) const;
};

/** Window around a lumen: −200 to 800 HU of a CT, or up to 1.4 times the lumen. */
GreyWindow windowFor(const Scan& scan, double lumen);

}  // namespace endovascular_sim::segmentation
