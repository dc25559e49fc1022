#pragma once

#include "common/archive.h"
#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

inline void archive(Archive& archive, Feature& feature)
{
  archive(feature.edge, feature.parameter, feature.point, feature.normal, feature.gap, feature.clearance_radius,
          feature.stiffness, feature.friction, feature.triangle, feature.id);
}

inline void archive(Archive& archive, ContactSet& set)
{
  archive(set.step, set.substep, set.pass, set.vessel_version, set.stale, set.first_edge, set.free_distance,
          set.features);
}

}  // namespace endovascular_sim::contact
