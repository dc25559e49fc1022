#include "fluoroscopy/beam/device_response.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kPatients[] = {100.0, 200.0, 300.0, 400.0};  // areal densities of tissue [kg/m²]
constexpr double kTissueStep = 30.0;                          // between the levels of the fit [kg/m²]
constexpr int kLevels = 21;
constexpr double kThickest = 60.0;  // areal density of steel of the fit [kg/m²]
constexpr int kThicknesses = 40;

/** Mean of a table weighted with a spectrum. */
double mean(const Spectrum& weight, const EnergyTable& table)
{
  double sum = 0.0, total = 0.0;
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
  {
    sum += weight[e] * table[e];
    total += weight[e];
  }
  return sum / total;
}

double total(const Spectrum& spectrum)
{
  double sum = 0.0;
  for (const double value : spectrum)
    sum += value;
  return sum;
}

}  // namespace

DeviceResponse::DeviceResponse(const Beam& beam, const MaterialLibrary& library)
  : library_(library),
    steel_(massAttenuationTable(library.composition("steel"))),
    water_(massAttenuationTable(library.composition("water")))
{
  const EnergyTable tissue = massAttenuationTable(library.composition("soft_tissue"));
  for (const double thickness : kPatients)
    patients_.push_back(filtered(beam.signal(), tissue, thickness));
  for (int k = 0; k < kLevels; ++k)
    fitLevel(filtered(beam.signal(), tissue, kTissueStep * k));
}

/** Appends the coefficients behind one thickness of tissue: D (1 + β P) = m P (1 + α P) by least squares over P,
 * weighted with the transmission. */
void DeviceResponse::fitLevel(const Spectrum& signal)
{
  DeviceCoefficients level;
  const double slope = mean(signal, steel_);
  level.slope = static_cast<float>(slope);
  level.water = static_cast<float>(mean(signal, water_));
  Eigen::Matrix2d normal = 1e-12 * Eigen::Matrix2d::Identity();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int k = 1; k <= kThicknesses; ++k)
  {
    const double root = static_cast<double>(k) / kThicknesses;
    const double p = kThickest * root * root;
    const double depth = -std::log(total(filtered(signal, steel_, p)) / total(signal));
    const Eigen::Vector2d row(slope * p * p, -depth * p);  // of α and β
    const double weight = std::exp(-depth);
    normal += weight * row * row.transpose();
    right += weight * row * (depth - slope * p);
  }
  const Eigen::Vector2d solution = normal.ldlt().solve(right);
  level.alpha = static_cast<float>(std::max(solution[0], 0.0));
  level.beta = static_cast<float>(std::max(solution[1], 0.0));
  levels_.push_back(level);
}

DeviceDensity DeviceResponse::equivalent(const EnergyTable& mass, double density) const
{
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Spectrum& patient : patients_)
    for (const double depth : {0.0, 0.5, 1.0, 2.0})
    {
      const Spectrum hardened = filtered(patient, mass, depth / mean(patient, mass));
      const Eigen::Vector2d row(mean(hardened, steel_), mean(hardened, water_));
      const double weight = total(hardened) / total(patient);
      normal += weight * row * row.transpose();
      right += weight * row * mean(hardened, mass);
    }
  // A monoenergetic beam distinguishes one component only: the smallest solution.
  const Eigen::Vector2d solution = normal.completeOrthogonalDecomposition().solve(right);
  return {density * solution[0], density * solution[1]};
}

DeviceDensity DeviceResponse::solid(const std::string& material) const
{
  return equivalent(massAttenuationTable(library_.composition(material)), library_.density(material));
}

DeviceDensity DeviceResponse::blood(double iodine) const
{
  return solid("blood") + equivalent(massAttenuationTable(library_.composition("iodine")), iodine);
}

DeviceCoefficients DeviceResponse::coefficients(float steel_slope) const
{
  // Levels have decreasing slopes; all are equal for a monoenergetic beam.
  auto above = std::lower_bound(levels_.begin(), levels_.end(), steel_slope,
                                [](const DeviceCoefficients& level, float slope) { return level.slope > slope; });
  above = std::clamp(above, levels_.begin() + 1, levels_.end() - 1);
  const DeviceCoefficients& a = *(above - 1);
  const DeviceCoefficients& b = *above;
  const float width = a.slope - b.slope;
  const float weight = width > 0.0F ? std::clamp((a.slope - steel_slope) / width, 0.0F, 1.0F) : 0.0F;
  return {steel_slope, a.alpha + weight * (b.alpha - a.alpha), a.beta + weight * (b.beta - a.beta),
          a.water + weight * (b.water - a.water)};
}

}  // namespace endovascular_sim::fluoroscopy
