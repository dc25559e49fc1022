#include "fluoroscopy/projection/x_ray_instrument.h"

#include <algorithm>
#include <utility>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Lumen of a hollow chain: cylinders of negative attenuation that correct the solid ones. */
XRayWire lumenOf(XRayWire chain, double inner_radius)
{
  for (double& attenuation : chain.attenuation)
    attenuation = -attenuation;
  chain.radius.assign(chain.nodes.size(), inner_radius);
  return chain;
}

}  // namespace

void trimDistal(std::vector<Eigen::Vector3d>& nodes, double length)
{
  while (nodes.size() > 1 && length > 0.0)
  {
    const Eigen::Vector3d edge = nodes[nodes.size() - 1] - nodes[nodes.size() - 2];
    const double edge_length = edge.norm();
    if (length < edge_length)
    {
      nodes.back() -= length / edge_length * edge;
      return;
    }
    length -= edge_length;
    nodes.pop_back();
  }
  if (nodes.size() == 1)
    nodes.clear();
}

XRayInstrument::XRayInstrument(const instrument::Instrument& instrument, const MaterialLibrary& table, double energy,
                               double displaced)
  : instrument_(&instrument)
{
  if (instrument.materials.size() != instrument.wire.sections.size())
    throw InputError(instrument.name, "materials", "must have one material per section of the wire");
  for (const instrument::Material material : instrument.materials)
    section_attenuation_.push_back(table.linear(instrument::materialName(material), energy) - displaced);
  for (const instrument::Marker& marker : instrument.markers)
    marker_attenuation_.push_back(table.linear(instrument::materialName(marker.material), energy) -
                                  (section_attenuation_.back() + displaced));
}

void XRayInstrument::append(const std::vector<Eigen::Vector3d>& nodes, double behind,
                            std::vector<XRayWire>& wires) const
{
  std::vector<Eigen::Vector3d> covered = nodes;
  trimDistal(covered, behind);
  if (covered.size() < 2 || section_attenuation_.empty())
    return;
  const XRayWire solid = shaft(std::move(covered));
  wires.push_back(solid);
  const double inner = instrument_->inner_radius;
  if (inner > 0.0)
    wires.push_back(lumenOf(solid, inner));
  for (std::size_t m = 0; m < instrument_->markers.size(); ++m)
  {
    const XRayWire marker = markerBand(solid, m);
    if (marker.nodes.empty())
      continue;
    wires.push_back(marker);
    if (inner > 0.0)
      wires.push_back(lumenOf(marker, inner));
  }
}

/** Assigns each edge to the section at its midpoint. */
XRayWire XRayInstrument::shaft(std::vector<Eigen::Vector3d> nodes) const
{
  const std::vector<rod::Section>& sections = instrument_->wire.sections;
  XRayWire result;
  result.nodes = std::move(nodes);
  result.attenuation.resize(result.nodes.size() - 1);
  result.radius.resize(result.nodes.size());
  std::size_t section = sections.size() - 1;
  double section_end = sections[section].length;  // distance from the tip to the section's proximal end
  double from_tip = 0.0;
  result.radius.back() = sections[section].radius;
  for (std::size_t j = result.attenuation.size(); j-- > 0;)
  {
    const double length = (result.nodes[j + 1] - result.nodes[j]).norm();
    while (from_tip + 0.5 * length > section_end && section > 0)
      section_end += sections[--section].length;
    result.attenuation[j] = section_attenuation_[section];
    result.radius[j] = sections[section].radius;
    from_tip += length;
  }
  return result;
}

XRayWire XRayInstrument::markerBand(const XRayWire& shaft, std::size_t marker) const
{
  const instrument::Marker& band = instrument_->markers[marker];
  XRayWire result;
  result.nodes = shaft.nodes;
  trimDistal(result.nodes, band.from_tip);
  double length = 0.0;
  for (std::size_t j = 0; j + 1 < result.nodes.size(); ++j)
    length += (result.nodes[j + 1] - result.nodes[j]).norm();
  std::reverse(result.nodes.begin(), result.nodes.end());
  trimDistal(result.nodes, length - band.length);
  if (result.nodes.size() < 2)
    return {};
  result.radius.assign(result.nodes.size(), instrument_->wire.radiusAt(instrument_->wire.length() - band.from_tip));
  result.attenuation.assign(result.nodes.size() - 1, marker_attenuation_[marker]);
  return result;
}

}  // namespace endovascular_sim::fluoroscopy
