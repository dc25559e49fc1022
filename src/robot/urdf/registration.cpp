#include "robot/urdf/urdf_reader.h"
#include "robot/urdf_source.h"

namespace endovascular_sim::robot
{

// Part of every program that links this library.
[[maybe_unused]] const bool kUrdfReaderRegistered = registerUrdfReader(&readUrdf);

}  // namespace endovascular_sim::robot
