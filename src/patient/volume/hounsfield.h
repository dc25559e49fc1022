#pragma once

#include "patient/volume/density_volume.h"

namespace endovascular_sim::patient
{

/** Soft tissue and bone of a CT number.
 *
 *  The mass density follows U. Schneider, E. Pedroni, A. Lomax, Phys. Med. Biol. 41:111, 1996, and W. Schneider, T.
 * Bortfeld, W. Schlegel, Phys. Med. Biol. 45:459, 2000:
 *
 *      ρ/(kg/m³) = 1.21 at −1000 HU, linear to 930 at −98 HU       air, lung, fat
 *                = 1018 + 0.893 H       −98 ≤ H ≤ 14               fat, muscle, organs
 *                = 1017 + 0.592 H       100 ≤ H                    marrow to cortical bone
 *
 *  and is linear between 14 and 100 HU. (The paper's steeper line for connective tissue there, which ends 44 kg/m³
 * above the line of bone, would not be monotone.) Above 100 HU the voxel is a mixture of marrow at 100 HU (1076 kg/m³)
 * and cortical bone at 1524 HU (1919 kg/m³); both lie on the line. Beyond 1524 HU it is bone of the line's density.
 *
 *  @param number CT number [HU]; below −1000 counts as −1000, NaN as air */
Density densityFromHounsfield(double number);

/** CT number of a mixture, by its mass density on the same lines: the inverse of densityFromHounsfield() [HU]. */
double hounsfieldOf(const Density& density);

}  // namespace endovascular_sim::patient
