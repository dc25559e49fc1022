#include "fluoroscopy/image/exposure_control.h"

#include <algorithm>
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
  requirePositive("max_air_kerma_rate", settings.max_air_kerma_rate);
}

double ExposureControl::referenceKerma(double tube_charge, double source_to_patient) const
{
  const double distance = std::max(source_to_patient - kReferencePoint, 0.1 * source_to_patient);
  return tube_charge * entrance_kerma_ / (distance * distance);
}

double ExposureControl::largestCharge(double source_to_patient) const
{
  return settings_.max_air_kerma_rate / settings_.rate / referenceKerma(1.0, source_to_patient);
}

double ExposureControl::tubeCharge(double log_signal, double source_to_detector, double source_to_patient) const
{
  const double kerma = water_.detectorKerma(water_.thickness(log_signal));
  const double wanted = settings_.detector_dose * source_to_detector * source_to_detector / kerma;
  return std::min(wanted, largestCharge(source_to_patient));
}

}  // namespace endovascular_sim::fluoroscopy
