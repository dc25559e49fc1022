#include "fluoroscopy/projection/coaxial_stack.h"

#include <algorithm>
#include <limits>
#include <string>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kShortest = 1e-7;  // edges shorter than this are not split off [m]

/** Distances from the last node at which the cross section of any instrument changes, increasing [m]. */
std::vector<double> changes(const std::vector<XRayInstrument>& instruments, const std::vector<double>& behind)
{
  std::vector<double> result;
  for (std::size_t k = 0; k < instruments.size(); ++k)
  {
    result.push_back(behind[k]);
    for (const double change : instruments[k].changes())
      result.push_back(behind[k] + change);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/** Stack of instruments whose tips lie at different distances from the last node. */
struct Stack
{
  const std::vector<XRayInstrument>& instruments;
  const std::vector<double>& behind;
  const std::vector<DeviceDensity>& lumens;

  const DeviceDensity& lumen(std::size_t k, const LocalFluids& fluids) const
  {
    return lumens.empty() ? fluids.lumen : lumens[k];
  }

  /** Fluid around an instrument: that in the narrowest lumen which holds it there, or that around the stack. */
  const DeviceDensity& around(std::size_t k, double radius, double from_end, const LocalFluids& fluids) const
  {
    const DeviceDensity* result = &fluids.around;
    double narrowest = std::numeric_limits<double>::infinity();
    for (std::size_t other = 0; other < instruments.size(); ++other)
    {
      const double inner = instruments[other].innerRadius();
      if (other == k || from_end <= behind[other] || inner < radius || inner >= narrowest)
        continue;
      narrowest = inner;
      result = &lumen(other, fluids);
    }
    return *result;
  }

  /** Cross section at a distance from the last node. */
  WireProfile profileAt(double from_end, const LocalFluids& fluids) const
  {
    WireProfile profile;
    for (std::size_t k = 0; k < instruments.size(); ++k)
    {
      const double from_tip = from_end - behind[k];
      if (from_tip > 0.0)
        instruments[k].appendLayers(from_tip, around(k, instruments[k].radius(from_tip), from_end, fluids),
                                    lumen(k, fluids), profile);
    }
    return profile;
  }
};

}  // namespace

XRayWire coaxialStack(const std::vector<Eigen::Vector3d>& nodes, const std::vector<XRayInstrument>& instruments,
                      const std::vector<double>& behind, const std::vector<LocalFluids>& fluids,
                      const std::vector<DeviceDensity>& lumens)
{
  if (behind.size() != instruments.size())
    throw InputError("X-ray instruments", "behind", "must have one value per instrument");
  if (!lumens.empty() && lumens.size() != instruments.size())
    throw InputError("X-ray instruments", "lumens", "must have one value per instrument, or none");
  if (fluids.empty() || (fluids.size() > 1 && fluids.size() + 1 != nodes.size()))
    throw InputError("X-ray instruments", "fluids", "must have one value, or one per edge of the centreline");
  const Stack stack{instruments, behind, lumens};
  XRayWire wire;
  if (nodes.size() < 2)
    return wire;
  std::vector<double> from_end(nodes.size(), 0.0);
  for (std::size_t i = nodes.size() - 1; i-- > 0;)
    from_end[i] = from_end[i + 1] + (nodes[i + 1] - nodes[i]).norm();
  std::vector<double> cuts = changes(instruments, behind);  // the next one is the last
  wire.nodes.push_back(nodes.front());
  for (std::size_t j = 0; j + 1 < nodes.size(); ++j)
  {
    const LocalFluids& local = fluids.size() == 1 ? fluids.front() : fluids[j];
    double from = from_end[j];
    const double to = from_end[j + 1];
    while (!cuts.empty() && cuts.back() >= from - kShortest)
      cuts.pop_back();
    while (!cuts.empty() && cuts.back() > to + kShortest)
    {
      const double cut = cuts.back();
      cuts.pop_back();
      if (cut > from - kShortest)
        continue;
      const double weight = (from_end[j] - cut) / (from_end[j] - to);
      appendEdge(wire, nodes[j] + weight * (nodes[j + 1] - nodes[j]), stack.profileAt(0.5 * (from + cut), local));
      from = cut;
    }
    appendEdge(wire, nodes[j + 1], stack.profileAt(0.5 * (from + to), local));
  }
  return wire;
}

}  // namespace endovascular_sim::fluoroscopy
