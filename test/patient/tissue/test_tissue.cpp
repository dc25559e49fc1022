#include "patient/tissue/tissue.h"

#include <gtest/gtest.h>

#include "patient/volume/hounsfield.h"

namespace endovascular_sim::patient
{
namespace
{

TEST(Tissue, HasTheCtNumberOfItsDensityUnlessItHoldsContrastMedium)
{
  for (int k = 0; k <= static_cast<int>(Tissue::kCardiacVein); ++k)
  {
    const TissueProperties& properties = propertiesOf(static_cast<Tissue>(k));
    const double of_density = hounsfieldOf({properties.density, 0.0});
    if (hasContrast(static_cast<Tissue>(k)))
      EXPECT_GT(properties.hounsfield, of_density + 30.0) << k;
    else
      EXPECT_NEAR(properties.hounsfield, of_density, 2.0) << k;
  }
}

}  // namespace
}  // namespace endovascular_sim::patient
