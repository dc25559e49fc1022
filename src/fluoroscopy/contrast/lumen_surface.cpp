#include "fluoroscopy/contrast/lumen_surface.h"

namespace endovascular_sim::fluoroscopy
{

DepthPlane::DepthPlane(const Corner& a, const Corner& b, const Corner& c)
{
  const auto area = static_cast<double>(edgeFunction(a, b, c.column, c.row));
  if (area == 0.0)
    return;
  valid_ = true;
  least_ = std::min({a.inverse_depth, b.inverse_depth, c.inverse_depth});
  most_ = std::max({a.inverse_depth, b.inverse_depth, c.inverse_depth});
  const double to_b = b.inverse_depth - a.inverse_depth, to_c = c.inverse_depth - a.inverse_depth;
  const auto scale = static_cast<double>(kSubpixels) / area;
  const auto column_b = static_cast<double>(b.column - a.column), row_b = static_cast<double>(b.row - a.row);
  const auto column_c = static_cast<double>(c.column - a.column), row_c = static_cast<double>(c.row - a.row);
  along_columns_ = (to_b * row_c - to_c * row_b) * scale;
  along_rows_ = (to_c * column_b - to_b * column_c) * scale;
  at_origin_ =
      a.inverse_depth - (along_rows_ * static_cast<double>(a.row) + along_columns_ * static_cast<double>(a.column)) /
                            static_cast<double>(kSubpixels);
}

}  // namespace endovascular_sim::fluoroscopy
