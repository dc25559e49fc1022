#include "fluoroscopy/image/detector_image.h"

#include <algorithm>
#include <cmath>

#include "common/wide_vectors.h"
#include "fluoroscopy/image/noise_source.h"
#include "fluoroscopy/image/scatter.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kReference = 200.0;  // areal density of water that relates signal and air kerma [kg/m²]

/** Adds scatter and quantum noise: s + √(s·W/q)·g, multiplied by the gain. */
EVS_WIDE_VECTORS void addNoise(float* signal, const float* scatter, const float* weight, const float* normal, int count,
                               float inverse_quanta, float gain)
{
  for (int i = 0; i < count; ++i)
  {
    const float total = signal[i] + scatter[i];
    const float variance = total * weight[i] * inverse_quanta;
    signal[i] = gain * (total + std::sqrt(variance > 0.0F ? variance : 0.0F) * normal[i]);
  }
}

EVS_WIDE_VECTORS void readOut(const float* signal, const float* normal, int count, float noise, std::uint16_t* raw)
{
  for (int i = 0; i < count; ++i)
  {
    float value = signal[i] + noise * normal[i] + 0.5F;
    value = value > 0.0F ? value : 0.0F;
    value = value < 65535.0F ? value : 65535.0F;
    raw[i] = static_cast<std::uint16_t>(static_cast<std::int32_t>(value));
  }
}

}  // namespace

DetectorImage::DetectorImage(int pixels, double width, double source_to_detector, const WaterEquivalent& water,
                             double field)
  : pixels_(pixels),
    width_(width),
    field_(field),
    quanta_(std::pow(width / pixels / source_to_detector, 2)),
    gain_(kCountsPerGray * water.detectorKerma(kReference) / std::exp(water.logSignal(kReference)) /
          (source_to_detector * source_to_detector)),
    water_(water),
    blur_(width / pixels),
    scatter_(pixels),
    counts_(pixels)
{
}

void DetectorImage::form(const FrameExposure& exposure, std::vector<float>& primary, const CoarseImage& mean,
                         const std::vector<float>& weight, std::vector<std::uint16_t>& raw)
{
  const auto n = static_cast<std::size_t>(pixels_);
  scatter_ = mean;
  scatter(scatter_, water_, width_, pixels_, field_);
  const auto gain = static_cast<float>(gain_ * exposure.tube_charge);
  counts_ = mean;
  for (std::size_t k = 0; k < counts_.values().size(); ++k)
    counts_.values()[k] = gain * (counts_.values()[k] + scatter_.values()[k]);
  const auto inverse_quanta = static_cast<float>(1.0 / (quanta_ * exposure.tube_charge));
  const NoiseSource noise(exposure.seed, exposure.frame);
  read_out_.resize(n * n);
  std::vector<float> normal(n), scattered(n);
  for (std::size_t row = 0; row < n; ++row)
  {
    noise.fill(static_cast<std::uint32_t>(row * n), pixels_, normal.data(), read_out_.data() + row * n);
    scatter_.row(static_cast<int>(row), scattered.data());
    addNoise(primary.data() + row * n, scattered.data(), weight.data() + row * n, normal.data(), pixels_,
             inverse_quanta, gain);
  }
  blur_.apply(pixels_, primary);
  raw.resize(n * n);
  for (std::size_t row = 0; row < n; ++row)
    readOut(primary.data() + row * n, read_out_.data() + row * n, pixels_, static_cast<float>(kReadOutNoise),
            raw.data() + row * n);
}

}  // namespace endovascular_sim::fluoroscopy
