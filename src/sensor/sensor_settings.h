#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace endovascular_sim::sensor
{

enum class SensorKind
{
  kEmTracker,    ///< pose of a tip: position [m], quaternion x, y, z, w
  kEncoder,      ///< insertion [m] and rotation [rad] of a handle
  kForceSensor,  ///< force [N] and torque [N·m] on a handle
  kDetector,     ///< column and row of a tip on the X-ray detector [pixel]
};

constexpr std::size_t kMostErrors = 6;

/** Sensor of a scene, with its errors. An error has one component per number of the sensor, for an EM tracker those of
 *  the position in the patient frame [m] and of a rotation vector in the axes of the tip [rad]. */
struct SensorSettings
{
  std::string name;
  SensorKind kind = SensorKind::kEncoder;
  std::size_t instrument = 0;
  double rate = 0.0;                        ///< of samples [Hz]; 0: one at every step
  double delay = 0.0;                       ///< from the measurement to the delivery of a sample [s]
  double drop_out = 0.0;                    ///< probability that a sample is lost [1]
  std::array<double, kMostErrors> noise{};  ///< standard deviations of the components
  std::array<double, kMostErrors> bias{};   ///< constant errors of the components
  std::uint64_t seed = 0;                   ///< varies the random numbers of this sensor
};

/** Number of components of the error of a kind. */
constexpr std::size_t errorsOf(SensorKind kind)
{
  return kind == SensorKind::kEmTracker ? 6 : 2;
}

/** Number of values of a reading of a kind. */
constexpr std::size_t valuesOf(SensorKind kind)
{
  return kind == SensorKind::kEmTracker ? 7 : 2;
}

}  // namespace endovascular_sim::sensor
