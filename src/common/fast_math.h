#pragma once

#include <cstdint>
#include <cstring>

namespace endovascular_sim
{

/** Exponential function in single precision without branches, for loops that the compiler vectorises. The relative
 * error is below 3e-7. Arguments are limited to ±87. */
inline float fastExp(float x)
{
  x = x > 87.0F ? 87.0F : x;
  x = x < -87.0F ? -87.0F : x;
  constexpr float kRound = 12582912.0F;  // 1.5·2²³: the sum has the nearest integer in its last bits
  const float shifted = x * 1.44269504F + kRound;
  const float n = shifted - kRound;
  const float r = (x - n * 0.693359375F) + n * 2.12194440e-4F;
  const float p =
      1.0F +
      r * (1.0F + r * (0.5F + r * (0.166666657F + r * (4.16657962e-2F + r * (8.33312049e-3F + r * 1.39897425e-3F)))));
  const std::int32_t bits = (static_cast<std::int32_t>(n) + 127) << 23;
  float scale = 0.0F;
  std::memcpy(&scale, &bits, sizeof scale);
  return p * scale;
}

/** Natural logarithm in single precision without branches, for loops that the compiler vectorises. The error is below
 * 3e-7 plus 2e-7 of the value. @pre x is a positive normal number */
inline float fastLog(float x)
{
  std::int32_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  // Mantissa in [√½, √2).
  const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;
  bits -= exponent * (1 << 23);
  float m = 0.0F;
  std::memcpy(&m, &bits, sizeof m);
  // ln m = 2 artanh(z), z = (m − 1)/(m + 1), |z| < 0.172.
  const float z = (m - 1.0F) / (m + 1.0F);
  const float z2 = z * z;
  const float series = 2.0F + z2 * (0.666666667F + z2 * (0.4F + z2 * (0.285714286F + z2 * 0.222222222F)));
  return static_cast<float>(exponent) * 0.693147181F + z * series;
}

}  // namespace endovascular_sim
