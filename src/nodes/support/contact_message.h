#pragma once

#include <cstdint>
#include <type_traits>

#include <ros/serialization.h>

#include "endovascular_sim/ContactSet.h"

// A feature's numbers stand on the wire as they do in memory, so that roscpp may copy a set's features as one block: a
// filled balloon has a thousand of them in every set.
static_assert(std::is_trivially_copyable<endovascular_sim::ContactFeature>::value, "its numbers are all there is");
static_assert(sizeof(endovascular_sim::ContactFeature) == 2 * sizeof(std::int32_t) + 12 * sizeof(double),
              "ContactFeature.msg must order its fields so that there is no padding between them");

namespace ros::message_traits
{

template <>
struct IsSimple<endovascular_sim::ContactFeature> : public TrueType
{
};

}  // namespace ros::message_traits
