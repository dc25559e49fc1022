#include "patient/solid/texture.h"

#include <algorithm>
#include <cmath>

#include "patient/solid/counter_random.h"

namespace endovascular_sim::patient
{
namespace
{

float latticeValue(int x, int y, int z, std::uint64_t seed)
{
  const auto part = [](int value) { return static_cast<std::uint64_t>(value + (1 << 20)); };
  const std::uint64_t bits = mixedBits(seed ^ (part(x) | part(y) << 21 | part(z) << 42));
  return static_cast<float>(bits >> 40) * (2.0F / 16777216.0F) - 1.0F;
}

}  // namespace

float valueNoise(const Point& p, float cell, std::uint64_t seed)
{
  const Point q = p / cell;
  const int x = static_cast<int>(std::floor(q.x())), y = static_cast<int>(std::floor(q.y())),
            z = static_cast<int>(std::floor(q.z()));
  const float fx = q.x() - static_cast<float>(x), fy = q.y() - static_cast<float>(y),
              fz = q.z() - static_cast<float>(z);
  const auto line = [&](int j, int k)
  {
    const float a = latticeValue(x, y + j, z + k, seed);
    return a + fx * (latticeValue(x + 1, y + j, z + k, seed) - a);
  };
  const auto plane = [&](int k)
  {
    const float a = line(0, k);
    return a + fy * (line(1, k) - a);
  };
  const float a = plane(0);
  return a + fz * (plane(1) - a);
}

float trabecularTexture(const Point& p, std::uint64_t seed)
{
  const float noise = 0.75F * valueNoise(p, 1.6F, seed) + 0.55F * valueNoise(p, 4.0F, seed + 1);
  return std::clamp(1.0F + noise, 0.15F, 2.0F);
}

float softTexture(const Point& p, std::uint64_t seed)
{
  return 1.0F + 0.02F * valueNoise(p, 9.0F, seed);
}

}  // namespace endovascular_sim::patient
