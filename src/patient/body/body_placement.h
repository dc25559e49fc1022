#pragma once

#include <string>

#include "patient/solid/voxeliser.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::patient
{

/** Placement of the body about a vessel. */
struct BodyPlacement
{
  BodyFrame frame;
  std::string note;           ///< how the frame was found, for the log
  bool by_landmarks = false;  ///< false: fitted to the extent of the vessel
};

/** Places the body by the landmarks of the vessel's centreline: the end of the branch `abdominal_aorta` (bifurcation,
 * level of L4) and the highest point of `aortic_arch` (lower edge of T4). The scale is limited to 0.8 to 1.25.
 *
 *  Without these branches the body is fitted to the extent of the mesh: a vessel of more than 350 mm height is taken as
 * the tree from the groins to the neck, a shorter one as the vessels of the heart. The note says so. */
BodyPlacement placeBody(const vessel::Vessel& vessel);

}  // namespace endovascular_sim::patient
