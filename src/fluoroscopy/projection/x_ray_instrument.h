#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/beam/material_library.h"
#include "fluoroscopy/projection/wire_projection.h"
#include "instrument/instrument.h"

namespace endovascular_sim::fluoroscopy
{

/** X-ray model of an instrument: shaft sections, lumen and marker bands. */
class XRayInstrument
{
public:
  /** @param instrument must outlive this object
   *  @param energy photon energy [keV]
   *  @param displaced linear attenuation coefficient of the displaced medium [1/m]
   *  @throws InputError for a material that is missing in the table, or sections without materials */
  XRayInstrument(const instrument::Instrument& instrument, const MaterialLibrary& table, double energy,
                 double displaced);

  /** Appends the X-ray wires of the instrument.
   *  @param nodes common centreline, from proximal to distal [m]
   *  @param behind arc length from the instrument's tip to the last node [m] */
  void append(const std::vector<Eigen::Vector3d>& nodes, double behind, std::vector<XRayWire>& wires) const;

private:
  XRayWire shaft(std::vector<Eigen::Vector3d> nodes) const;
  XRayWire markerBand(const XRayWire& shaft, std::size_t marker) const;

  const instrument::Instrument* instrument_;
  std::vector<double> section_attenuation_;  ///< coefficient minus that of the displaced medium [1/m]
  std::vector<double> marker_attenuation_;   ///< coefficient minus that of the shaft [1/m]
};

/** Trims a polyline by @p length [m] at its distal end; a shorter polyline becomes empty. */
void trimDistal(std::vector<Eigen::Vector3d>& nodes, double length);

}  // namespace endovascular_sim::fluoroscopy
