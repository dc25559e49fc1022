#include "fluoroscopy/beam/tube_spectrum.h"

#include <algorithm>
#include <cmath>

#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kPi;
constexpr int kSteps = 200;  // of the integrals over electron energy and depth

// Fitted constants.
constexpr double kPenetration = 1.15;       // factor of the Thomson–Whiddington constant
constexpr double kBremsstrahlung = 1107.0;  // factor of the bremsstrahlung
constexpr double kCharacteristic = 1.52;    // factor of the yield of the K lines

// Constants of the paper.
constexpr double kRestEnergy = 511.0;        // of the electron [keV]
constexpr double kCrossSection = 1.0396e-2;  // α r_e² Z² N_A / A of tungsten [cm²/g]
constexpr double kEdge = 69.525;             // K edge of tungsten [keV]
constexpr double kYield = 1.349e-3;          // of K photons [1/electron]
constexpr double kYieldExponent = 1.648;
struct Line
{
  std::size_t energy;  // [keV]
  double fraction;     // of the K photons
};
constexpr Line kLines[] = {{59, 0.505}, {58, 0.291}, {67, 0.162}, {69, 0.042}};

/** Thomson–Whiddington constant [keV²·cm²/g], interpolated between 50 and 200 kV and extrapolated below. */
double penetration(double voltage)
{
  constexpr double kVoltage[] = {50.0, 75.0, 100.0, 150.0, 200.0};
  constexpr double kConstant[] = {5.4e5, 6.25e5, 7.0e5, 8.4e5, 10.0e5};
  const auto* above = std::clamp(std::upper_bound(std::begin(kVoltage), std::end(kVoltage), voltage),
                                 std::begin(kVoltage) + 1, std::end(kVoltage) - 1);
  const auto k = above - std::begin(kVoltage);
  const double fraction = (voltage - kVoltage[k - 1]) / (kVoltage[k] - kVoltage[k - 1]);
  return kPenetration * (kConstant[k - 1] + fraction * (kConstant[k] - kConstant[k - 1]));
}

/** Mass stopping power of tungsten [keV·cm²/g]. */
double stoppingPower(double energy)
{
  return 2024.1 + 10361.0 * std::exp(-0.04695 * energy);
}

/** Bremsstrahlung of energy @p e per electron and keV. */
double bremsstrahlung(double e, double voltage, double mass, double path)
{
  const double width = (voltage - e) / kSteps;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k)
  {
    const double t = e + (k + 0.5) * width;
    const double u = e / t;
    const double b = 1.0 + u * (-5.049 + u * (10.847 + u * (-10.516 + u * 3.842)));
    const double escape = std::exp(-mass * (voltage * voltage - t * t) / path);
    sum += b * (t + kRestEnergy) / t * escape / stoppingPower(t);
  }
  return kBremsstrahlung * kCrossSection / e * (3.685e-2 + 2.9e-5 * voltage) * sum * width;
}

/** Mean transmission of a K line from its depths of production. */
double escapeOfLine(double mass, double range, double sine)
{
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k)
  {
    const double x = (k + 0.5) / kSteps;
    sum += 1.5 * (1.0 - x * x) * std::exp(-mass * x * range / sine) / kSteps;
  }
  return sum;
}

}  // namespace

Spectrum tungstenSpectrum(double voltage, double anode_angle)
{
  static const EnergyTable kTungsten = massAttenuationTable({{"W", 1.0}});
  constexpr double kPerGram = 10.0;  // m²/kg to cm²/g
  constexpr double kElementaryCharge = 1.602176634e-19;
  constexpr double kPhotons = kCoulombPerMas / kElementaryCharge / (4.0 * kPi);  // 1/electron to 1/(m²·mAs) at 1 m
  const double constant = penetration(voltage), sine = std::sin(anode_angle);
  Spectrum spectrum{};
  for (std::size_t bin = kLowestEnergy; bin < kEnergies; ++bin)
  {
    const auto middle = static_cast<double>(bin);
    const double width = std::clamp(voltage - (middle - 0.5), 0.0, 1.0);  // of the part of the bin below the end point
    const double e = std::min(middle, middle - 0.5 + 0.5 * width);
    if (width > 0.0)
      spectrum[bin] = kPhotons * width * bremsstrahlung(e, voltage, kPerGram * kTungsten[bin], constant * sine);
  }
  if (voltage > kEdge)
  {
    const double range = (voltage * voltage - kEdge * kEdge) / constant;  // [g/cm²]
    const double yield = kCharacteristic * kYield * std::pow(voltage / kEdge - 1.0, kYieldExponent);
    for (const Line& line : kLines)
      spectrum[line.energy] +=
          kPhotons * yield * line.fraction * escapeOfLine(kPerGram * kTungsten[line.energy], range, sine);
  }
  return spectrum;
}

}  // namespace endovascular_sim::fluoroscopy
