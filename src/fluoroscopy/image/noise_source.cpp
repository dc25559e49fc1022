#include "fluoroscopy/image/noise_source.h"

#include <cmath>

#include "common/fast_math.h"
#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** sin(πx)/(x(1 − x²)) by its power series in x², |x| ≤ ½. */
inline float sinPi(float x)
{
  const float y = x * x;
  const float series =
      3.14159265F + y * (-2.02612017F + y * (0.52404387F + y * (-0.07522066F + y * (0.00692523F - y * 0.00044520F))));
  return x * (1.0F - y) * series;
}

EVS_WIDE_VECTORS void normals(std::uint32_t first, int count, std::uint32_t key0, std::uint32_t key1,
                              std::uint32_t key2, std::uint32_t key3, float* a, float* b)
{
  constexpr float kUnit = 1.0F / 16777216.0F;
  for (int i = 0; i < count; ++i)
  {
    const std::uint32_t counter = (first + static_cast<std::uint32_t>(i)) * 0x9e3779b9U;
    const std::uint32_t h = mixedBits32(mixedBits32(counter + key0) ^ key1);
    const std::uint32_t g = mixedBits32(mixedBits32(h + key2) ^ key3);
    const auto u = static_cast<float>(static_cast<std::int32_t>(h >> 8) + 1) * kUnit;        // in (0, 1]
    const auto v = static_cast<float>(static_cast<std::int32_t>(g >> 8) - 8388608) * kUnit;  // in [−½, ½)
    const float square = -2.0F * fastLog(u);
    const float radius = std::sqrt(square > 0.0F ? square : 0.0F);
    const float sine = sinPi(v);  // of half the angle
    const float rest = 1.0F - sine * sine;
    a[i] = radius * (rest - sine * sine);
    b[i] = radius * 2.0F * sine * std::sqrt(rest > 0.0F ? rest : 0.0F);
  }
}

}  // namespace

NoiseSource::NoiseSource(std::uint64_t seed, std::uint64_t frame) : keys_(counterKeys(seed, frame)) {}

void NoiseSource::fill(std::uint32_t first, int count, float* a, float* b) const
{
  normals(first, count, keys_[0], keys_[1], keys_[2], keys_[3], a, b);
}

}  // namespace endovascular_sim::fluoroscopy
