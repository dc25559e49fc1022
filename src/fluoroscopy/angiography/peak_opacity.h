#pragma once

#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Peak opacity of a run: per pixel the largest −s (logDifference()) of all its frames.
 *
 *  Each frame is averaged over 3 × 3 pixels before, so that the largest values are less those of the noise. The median
 * of the image, where there is no contrast medium, is its zero; smaller values are 0. */
class PeakOpacity
{
public:
  /** Adds a frame of the run. @param difference s, row-major  @param pixels per side */
  void add(const std::vector<float>& difference, int pixels);

  bool empty() const { return largest_.empty(); }  ///< true before the first frame

  /** Peak opacity P above its zero, row-major [1]. @pre not empty() */
  std::vector<float> image() const;

private:
  std::vector<float> largest_;
};

}  // namespace endovascular_sim::fluoroscopy
