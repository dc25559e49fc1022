#include "fluoroscopy/beam/signal_table.h"

#include <algorithm>
#include <cmath>

#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr std::size_t kLanes = 8;  // partial sums of an integral, for the SIMD unit

double equidistant(int node, int nodes, double max)
{
  return max * node / (nodes - 1);
}

double quadratic(int node, int nodes, double max)
{
  const double root = equidistant(node, nodes, 1.0);
  return max * root * root;
}

template <typename Node>
std::vector<std::array<float, kEnergies>> exponentials(const EnergyTable& mass, int nodes, double max, const Node& node)
{
  std::vector<std::array<float, kEnergies>> result(static_cast<std::size_t>(nodes));
  for (int k = 0; k < nodes; ++k)
    for (std::size_t e = 0; e < kEnergies; ++e)
      result[static_cast<std::size_t>(k)][e] = static_cast<float>(std::exp(-mass[e] * node(k, nodes, max)));
  return result;
}

/** Sums of a product with three weights over the bins, in a fixed order for every instruction set. */
struct Sums
{
  float signal = 0.0F, variance = 0.0F, steel = 0.0F;
};

EVS_WIDE_VECTORS Sums sums(const float* base, const float* attenuated, const float* energy, const float* steel,
                           std::size_t bins)
{
  float a[kLanes] = {}, b[kLanes] = {}, c[kLanes] = {};
  for (std::size_t e = 0; e < bins; e += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k)
    {
      const float value = base[e + k] * attenuated[e + k];
      a[k] += value;
      b[k] += value * energy[e + k];
      c[k] += value * steel[e + k];
    }
  Sums result;
  for (std::size_t k = 0; k < kLanes; ++k)
  {
    result.signal += a[k];
    result.variance += b[k];
    result.steel += c[k];
  }
  return result;
}

/** Cell and weight of an interpolation. */
struct Place
{
  std::size_t cell;
  float weight;
};

Place equidistantPlace(double value, int nodes, double max)
{
  const double x = value / max * (nodes - 1);
  const int cell = std::clamp(static_cast<int>(x), 0, nodes - 2);
  return {static_cast<std::size_t>(cell), static_cast<float>(x - cell)};
}

Place quadraticPlace(double value, int nodes, double max)
{
  if (value == 0.0)
    return {0, 0.0F};
  const double n = nodes - 1;
  const double relative = value / max;
  const double cell = std::clamp(static_cast<int>(std::sqrt(std::max(relative, 0.0)) * n), 0, nodes - 2);
  return {static_cast<std::size_t>(cell), static_cast<float>((relative * n * n - cell * cell) / (2.0 * cell + 1.0))};
}

}  // namespace

SignalTable::SignalTable(const Beam& beam, const MaterialLibrary& library)
  : signal_(beam.signal()),
    tissue_(massAttenuationTable(library.composition("soft_tissue"))),
    bone_(massAttenuationTable(library.composition("cortical_bone"))),
    iodine_(massAttenuationTable(library.composition("iodine"))),
    steel_(massAttenuationTable(library.composition("steel")))
{
  fill(exponentials(tissue_, kTissueNodes, kTissueMax, equidistant),
       exponentials(bone_, kBoneNodes, kBoneMax, quadratic),
       exponentials(iodine_, kIodineNodes, kIodineMax, quadratic));
}

void SignalTable::fill(const Exponentials& tissue, const Exponentials& bone, const Exponentials& iodine)
{
  // Bins from the first to the last photon, padded with empty ones.
  constexpr std::size_t kPadded = kEnergies + kLanes;
  std::array<float, kPadded> signal{}, energy{}, steel{}, base{}, attenuated{};
  std::size_t first = kEnergies, last = 0;
  for (std::size_t e = 0; e < kEnergies; ++e)
    if (signal_[e] > 0.0)
    {
      first = std::min(first, e);
      last = e;
    }
  const std::size_t bins = (last - first + kLanes) / kLanes * kLanes;
  const double largest = *std::max_element(signal_.begin(), signal_.end());
  for (std::size_t e = first; e <= last; ++e)
  {
    signal[e - first] = static_cast<float>(signal_[e] / largest);
    energy[e - first] = static_cast<float>(e);
    steel[e - first] = static_cast<float>(steel_[e]);
  }
  const auto log_largest = static_cast<float>(std::log(largest));
  nodes_.reserve(tissue.size() * bone.size() * iodine.size());
  for (const auto& by_tissue : tissue)
    for (const auto& by_bone : bone)
    {
      float scale = 0.0F;  // keeps sums behind thick layers within the range of single precision
      for (std::size_t e = first; e <= last; ++e)
      {
        base[e - first] = signal[e - first] * by_tissue[e] * by_bone[e];
        scale = std::max(scale, base[e - first]);
      }
      for (float& value : base)
        value /= scale;
      for (const auto& by_iodine : iodine)
      {
        std::copy(by_iodine.begin() + static_cast<std::ptrdiff_t>(first),
                  by_iodine.begin() + static_cast<std::ptrdiff_t>(last) + 1, attenuated.begin());
        const Sums sum = sums(base.data(), attenuated.data(), energy.data(), steel.data(), bins);
        nodes_.push_back({std::log(sum.signal) + std::log(scale) + log_largest, sum.variance / sum.signal,
                          sum.steel / sum.signal, 0.0F});
      }
    }
}

Response SignalTable::at(const ArealDensities& densities) const
{
  const Place t = equidistantPlace(densities.tissue, kTissueNodes, kTissueMax);
  const Place b = quadraticPlace(densities.bone, kBoneNodes, kBoneMax);
  const Place i = quadraticPlace(densities.iodine, kIodineNodes, kIodineMax);
  constexpr std::size_t kRow = kIodineNodes, kPlane = kRow * kBoneNodes;
  const std::array<float, 4>* node = nodes_.data() + t.cell * kPlane + b.cell * kRow + i.cell;
  std::array<float, 4> value{};
  const auto interpolate = [&](const auto& along)
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      const float low = along(0, k) + b.weight * (along(kRow, k) - along(0, k));
      const float high = along(kPlane, k) + b.weight * (along(kPlane + kRow, k) - along(kPlane, k));
      value[k] = low + t.weight * (high - low);
    }
  };
  if (i.weight == 0.0F)  // beside the vessel
    interpolate([&](std::size_t offset, std::size_t k) { return node[offset][k]; });
  else
    interpolate([&](std::size_t offset, std::size_t k)
                { return node[offset][k] + i.weight * (node[offset + 1][k] - node[offset][k]); });
  return {value[0], value[1], value[2]};
}

Response SignalTable::integrate(const ArealDensities& densities) const
{
  double signal = 0.0, variance = 0.0, steel = 0.0;
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
  {
    if (signal_[e] <= 0.0)
      continue;
    const double value = signal_[e] * std::exp(-tissue_[e] * densities.tissue - bone_[e] * densities.bone -
                                               iodine_[e] * densities.iodine);
    signal += value;
    variance += value * static_cast<double>(e);
    steel += value * steel_[e];
  }
  return {static_cast<float>(std::log(signal)), static_cast<float>(variance / signal),
          static_cast<float>(steel / signal)};
}

}  // namespace endovascular_sim::fluoroscopy
