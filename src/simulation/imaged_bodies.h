#pragma once

#include <vector>

#include <Eigen/Core>

#include "intervention/vessel_dilatation.h"

namespace endovascular_sim::simulation
{

/** Instruments of an X-ray image, on their common centreline. */
struct ImagedInstruments
{
  std::vector<Eigen::Vector3d> nodes;  ///< from proximal to distal, in the moved patient [m]
  std::vector<double> behind;          ///< for each instrument: arc length from its tip to the last node [m]
};

/** Stent of an X-ray image, with the vessel at rest. */
struct ImagedStent
{
  intervention::RoundBody sleeve;
  double thickness = 0.0;  ///< of a strut [m]
};

/** Balloons and stents of an X-ray image, with the vessel at rest. */
struct ImagedTreatment
{
  std::vector<intervention::RoundBody> balloons;
  std::vector<ImagedStent> stents;
};

}  // namespace endovascular_sim::simulation
