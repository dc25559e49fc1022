#pragma once

#include <cstdint>
#include <vector>

#include "contrast/lumen/lumen_cells.h"
#include "fluoroscopy/contrast/iodine_image.h"
#include "fluoroscopy/projection/signed_depth.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Path lengths of each pixel's ray in parts of a lumen at rest, for one pose: a sparse matrix, pixel × part. Iodine
 *  along the rays is its product with the concentrations. */
class LumenMatrix
{
public:
  /** Path lengths in all parts.
   *  @param corners of all vertices of the lumen, in the image of @p geometry */
  void build(const XRayGeometry& geometry, const contrast::LumenCells& lumen, const std::vector<Corner>& corners);

  /** Extents in depth of some parts: path lengths per |d|, the length of the ray per depth.
   *  @param is_selected for each part */
  void buildDepths(const XRayGeometry& geometry, const contrast::LumenCells& lumen, const std::vector<Corner>& corners,
                   const std::vector<char>& is_selected);

  /** @param concentrations of the parts [kg/m³] */
  void multiply(const std::vector<double>& concentrations, IodineImage& image) const;

  /** Calls visit(pixel, areal density) for each row, by ascending pixels. */
  template <typename Visit>
  void forRows(const std::vector<double>& concentrations, const Visit& visit) const
  {
    for (std::size_t row = 0; row < pixels_.size(); ++row)
    {
      double sum = 0.0;
      for (std::uint32_t k = begin_[row]; k < begin_[row + 1]; ++k)
        sum += static_cast<double>(lengths_[k]) * concentrations[static_cast<std::size_t>(parts_[k])];
      visit(pixels_[row], sum);
    }
  }

  std::size_t entries() const { return lengths_.size(); }

private:
  /** Signed depth of one ray on one triangle. */
  struct Hit
  {
    std::uint32_t pixel = 0;
    int part = 0;
    double depth = 0.0;  ///< [m]
  };

  void collect(const XRayGeometry& geometry, const contrast::LumenCells& lumen, const std::vector<Corner>& corners,
               const std::vector<char>& is_selected);
  template <typename RayLength>
  void sortHits(int pixels, const RayLength& ray_length);
  void appendRow(std::uint32_t pixel, double ray, std::vector<Hit>::iterator begin, std::vector<Hit>::iterator end);

  std::vector<Hit> hits_, sorted_;
  std::vector<std::uint32_t> pixels_;  ///< of the rows, ascending
  std::vector<std::uint32_t> begin_;   ///< of the rows' entries, and the end
  std::vector<int> parts_;
  std::vector<float> lengths_;  ///< [m]
};

}  // namespace endovascular_sim::fluoroscopy
