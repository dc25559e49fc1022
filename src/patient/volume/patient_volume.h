#pragma once

#include <memory>
#include <string>
#include <vector>

#include "patient/volume/density_volume.h"

namespace endovascular_sim::patient
{

/** Volume of a patient in the patient frame, with blood in the lumen of the vessel. */
struct PatientVolume
{
  std::shared_ptr<const DensityVolume> volume;
  std::vector<std::string> notes;  ///< origin, placement, unusual properties: for the log
};

}  // namespace endovascular_sim::patient
