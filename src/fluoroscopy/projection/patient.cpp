#include "fluoroscopy/projection/patient.h"

#include <cstddef>

namespace endovascular_sim::fluoroscopy
{

const ArealDensityImage& SlabPatient::frame(const XRayGeometry& geometry)
{
  if (revision_ > 0 && geometry.pose() == pose_)
    return image_;
  pose_ = geometry.pose();
  image_ = emptyImage(geometry.pixels());
  std::size_t k = 0;
  for (int row = 0; row < geometry.pixels(); ++row)
    for (int column = 0; column < geometry.pixels(); ++column, ++k)
      image_.tissue[k] = static_cast<float>(thickness_ * density_ * geometry.ray(column, row).norm());
  ++revision_;
  return image_;
}

}  // namespace endovascular_sim::fluoroscopy
