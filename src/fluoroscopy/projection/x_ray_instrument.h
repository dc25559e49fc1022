#pragma once

#include <vector>

#include "fluoroscopy/beam/device_response.h"
#include "fluoroscopy/projection/wire.h"
#include "instrument/instrument.h"

namespace endovascular_sim::fluoroscopy
{

/** X-ray model of an instrument: shaft sections, lumen and marker bands, by the distance from the tip. */
class XRayInstrument
{
public:
  /** @throws InputError for a material that is missing in the library, or sections without materials */
  XRayInstrument(const instrument::Instrument& instrument, const DeviceResponse& response);

  /** Outer radius of the shaft [m].
   *  @param from_tip distance from the tip [m] */
  double radius(double from_tip) const { return section(from_tip).radius; }

  /** Radius of the lumen; 0 for a solid instrument [m]. */
  double innerRadius() const { return inner_radius_; }

  /** Distances from the tip at which the cross section changes [m]. */
  const std::vector<double>& changes() const { return changes_; }

  /** Appends the layers of the cross section.
   *  @param from_tip distance from the tip [m]
   *  @param around density of the fluid around the instrument
   *  @param lumen density of the fluid in its lumen */
  void appendLayers(double from_tip, const DeviceDensity& around, const DeviceDensity& lumen,
                    WireProfile& profile) const;

private:
  struct Section
  {
    double end;  ///< distance of its proximal end from the tip [m]
    double radius;
    DeviceDensity density;
  };
  struct Marker
  {
    double begin, end;  ///< distances from the tip [m]
    DeviceDensity density;
  };

  const Section& section(double from_tip) const;

  std::vector<Section> sections_;  ///< from distal to proximal; the last one has no end
  std::vector<Marker> markers_;
  std::vector<double> changes_;
  double inner_radius_;
};

}  // namespace endovascular_sim::fluoroscopy
