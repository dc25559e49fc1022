#pragma once

#include "drive/hand_motion.h"

namespace endovascular_sim::haptics
{

using drive::HandMotion;  ///< position of the user's hand on the instrument

}  // namespace endovascular_sim::haptics
