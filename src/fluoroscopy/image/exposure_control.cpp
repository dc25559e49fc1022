#include "fluoroscopy/image/exposure_control.h"

#include <cmath>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kReferencePoint = 0.15;  // from the isocentre towards the source [m]

void requirePositive(const char* key, double value)
{
  if (!std::isfinite(value) || !(value > 0.0))
    throw InputError("X-ray exposure", key, "must be positive");
}

}  // namespace

ExposureControl::ExposureControl(const Beam& beam, const ExposureSettings& settings)
  : settings_(settings), water_(beam), entrance_kerma_(airKerma(beam.entrance()))
{
  requirePositive("detector_dose", settings.detector_dose);
  requirePositive("rate", settings.rate);
  requirePositive("time_constant", settings.time_constant);
  requirePositive("max_air_kerma_rate", settings.max_air_kerma_rate);
}

double ExposureControl::referenceKerma(double tube_charge, double source_to_patient) const
{
  const double distance = std::max(source_to_patient - kReferencePoint, 0.1 * source_to_patient);
  return tube_charge * entrance_kerma_ / (distance * distance);
}

double ExposureControl::next(double log_signal, double source_to_detector, double source_to_patient)
{
  const double measured = water_.thickness(log_signal);
  const double step = 1.0 - std::exp(-1.0 / (settings_.rate * settings_.time_constant));
  thickness_ = thickness_ ? *thickness_ + step * (measured - *thickness_) : measured;
  const double wanted =
      settings_.detector_dose * source_to_detector * source_to_detector / water_.detectorKerma(*thickness_);
  const double highest = settings_.max_air_kerma_rate / settings_.rate / referenceKerma(1.0, source_to_patient);
  limited_ = wanted > highest;
  return limited_ ? highest : wanted;
}

}  // namespace endovascular_sim::fluoroscopy
