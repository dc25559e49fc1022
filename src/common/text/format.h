#pragma once

#include <string>

#include <Eigen/Core>

namespace endovascular_sim
{

/** Text of values in the notation of printf, e.g. `formatted("%.1f mm", 1e3 * length)`. The compiler checks the types.
 */
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/** Number with a count of significant digits and without trailing zeros, e.g. "0.25" or "1.2e+06". */
std::string shortNumber(double value, int digits = 6);

/** Length [m] in millimetres with four significant digits, e.g. "2.5 mm". */
std::string inMillimetres(double length);

/** Position [m] in millimetres with one decimal, e.g. "(1.0, -2.5, 30.0) mm". */
std::string inMillimetres(const Eigen::Vector3d& position);

}  // namespace endovascular_sim
