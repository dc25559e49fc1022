#include "fluoroscopy/projection/patient.h"

namespace endovascular_sim::fluoroscopy
{

void SlabPatient::project(const XRayGeometry& geometry, PatientImage& image) const
{
  const int n = geometry.pixels();
  const auto size = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  image.tissue.resize(size);
  image.bone.assign(size, 0.0F);
  std::size_t k = 0;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column, ++k)
      image.tissue[k] = static_cast<float>(areal_density_ * geometry.ray(column, row).norm());
}

}  // namespace endovascular_sim::fluoroscopy
