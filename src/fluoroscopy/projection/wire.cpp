#include "fluoroscopy/projection/wire.h"

#include <cmath>
#include <string>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{

void checkWire(const XRayWire& wire)
{
  const std::size_t edges = wire.nodes.empty() ? 0 : wire.nodes.size() - 1;
  if (wire.edge_profile.size() != edges)
    throw InputError("wire", "edge_profile",
                     "must have one profile per edge; there are " + std::to_string(wire.nodes.size()) + " nodes");
  for (std::size_t i = 0; i < wire.nodes.size(); ++i)
    if (!wire.nodes[i].allFinite())
      throw InputError("wire", "node " + std::to_string(i), "must be finite");
  for (const std::uint32_t profile : wire.edge_profile)
    if (profile >= wire.profiles.size())
      throw InputError("wire", "edge_profile", "must be an index of a profile");
  for (const WireProfile& profile : wire.profiles)
    for (const WireLayer& layer : profile)
      if (!std::isfinite(layer.radius) || layer.radius < 0.0 || !std::isfinite(layer.density.steel) ||
          !std::isfinite(layer.density.water))
        throw InputError("wire", "profiles", "must have finite densities and non-negative radii");
}

void appendEdge(XRayWire& wire, const Eigen::Vector3d& end, const WireProfile& profile)
{
  if (wire.profiles.empty() || !(wire.profiles.back() == profile))
    wire.profiles.push_back(profile);
  wire.nodes.push_back(end);
  wire.edge_profile.push_back(static_cast<std::uint32_t>(wire.profiles.size() - 1));
}

}  // namespace endovascular_sim::fluoroscopy
