#include "fluoroscopy/projection/x_ray_instrument.h"

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{

XRayInstrument::XRayInstrument(const instrument::Instrument& instrument, const DeviceResponse& response)
  : inner_radius_(instrument.inner_radius)
{
  if (instrument.materials.size() != instrument.wire.sections.size())
    throw InputError(instrument.name, "materials", "must have one material per section of the wire");
  double end = 0.0;
  for (std::size_t k = instrument.materials.size(); k-- > 0;)
  {
    end += instrument.wire.sections[k].length;
    sections_.push_back(
        {end, instrument.wire.sections[k].radius, response.solid(instrument::materialName(instrument.materials[k]))});
    if (k > 0)
      changes_.push_back(end);
  }
  for (const instrument::Marker& marker : instrument.markers)
  {
    markers_.push_back(
        {marker.from_tip, marker.from_tip + marker.length, response.solid(instrument::materialName(marker.material))});
    changes_.push_back(markers_.back().begin);
    changes_.push_back(markers_.back().end);
  }
}

const XRayInstrument::Section& XRayInstrument::section(double from_tip) const
{
  std::size_t k = 0;
  while (k + 1 < sections_.size() && from_tip > sections_[k].end)
    ++k;
  return sections_[k];
}

void XRayInstrument::appendLayers(double from_tip, const DeviceDensity& around, const DeviceDensity& lumen,
                                  WireProfile& profile) const
{
  const Section& shaft = section(from_tip);
  DeviceDensity density = shaft.density;
  for (const Marker& marker : markers_)
    if (from_tip >= marker.begin && from_tip <= marker.end)
      density = marker.density;
  profile.push_back({shaft.radius, density - around});
  if (inner_radius_ > 0.0)
    profile.push_back({inner_radius_, lumen - density});
}

}  // namespace endovascular_sim::fluoroscopy
