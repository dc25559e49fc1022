#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/attenuation.h"
#include "fluoroscopy/wire_projection.h"
#include "instrument/instrument.h"

namespace endovascular_sim::fluoroscopy
{

/** What X-rays see of an instrument: its shaft, section by section, without its lumen, and its marker rings. */
class XRayInstrument
{
public:
  /** @param instrument must outlive this
   *  @param energy of the photons [keV]
   *  @param displaced linear attenuation of what the instrument displaces [1/m]
   *  @throws InputError for a material that the table does not know, or sections without materials */
  XRayInstrument(const instrument::Instrument& instrument, const AttenuationTable& table, double energy,
                 double displaced);

  /** Appends the wires that it looks like.
   *  @param nodes a centreline that it follows, proximal to distal [m]
   *  @param behind how far its tip stays behind the last node [m] */
  void append(const std::vector<Eigen::Vector3d>& nodes, double behind, std::vector<XRayWire>& wires) const;

private:
  XRayWire shaft(std::vector<Eigen::Vector3d> nodes) const;
  XRayWire ring(const XRayWire& shaft, std::size_t marker) const;

  const instrument::Instrument* instrument_;
  std::vector<double> section_attenuation_;  ///< less that of what is displaced [1/m]
  std::vector<double> marker_attenuation_;   ///< less that of the shaft [1/m]
};

/** Takes the last @p length off a chain of nodes; nothing is left of a shorter one [m]. */
void cutDistal(std::vector<Eigen::Vector3d>& nodes, double length);

}  // namespace endovascular_sim::fluoroscopy
