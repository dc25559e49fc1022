#include "results/smoothness.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Core>
#include <unsupported/Eigen/FFT>

namespace endovascular_sim::results
{
namespace
{

constexpr double kCutoff = 10.0;     // cutoff frequency [Hz]
constexpr double kThreshold = 0.05;  // amplitude threshold relative to frequency 0
constexpr int kPadding = 4;          // zero padding: doublings beyond the next power of two

}  // namespace

double spectralArcLength(const std::vector<double>& speed, double rate)
{
  if (speed.empty() || *std::max_element(speed.begin(), speed.end()) <= 0.0)
    return 0.0;
  std::size_t size = 1;
  while (size < speed.size())
    size *= 2;
  size <<= kPadding;
  std::vector<double> padded(speed);
  padded.resize(size, 0.0);
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, padded);
  const double whole = std::abs(spectrum.front());
  const double step = rate / static_cast<double>(size);
  auto last = static_cast<std::size_t>(std::min(0.5 * rate, kCutoff) / step);
  while (last > 0 && std::abs(spectrum[last]) < kThreshold * whole)
    --last;
  if (last == 0)
    return 0.0;
  double length = 0.0;
  for (std::size_t k = 1; k <= last; ++k)
    length += std::hypot(1.0 / static_cast<double>(last), (std::abs(spectrum[k]) - std::abs(spectrum[k - 1])) / whole);
  return -length;
}

}  // namespace endovascular_sim::results
