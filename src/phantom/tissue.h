#pragma once

#include "image/volume.h"
#include "patient/tissue/tissue.h"
#include "patient/volume/density_volume.h"

namespace endovascular_sim::phantom
{

/** Value of a tissue in an image: Hounsfield units of a CT angiogram, or the signal of a magnetic resonance angiogram.
 * The signal of the lumen falls towards the feet.
 *  @param height of the point above the aortic bifurcation [m] */
double tissueValue(patient::Tissue tissue, image::Modality modality, double height);

/** Value of a voxel of the body: the CT number of its density, or the signal of the tissue that has it. */
double bodyValue(const patient::Density& density, image::Modality modality, double height);

}  // namespace endovascular_sim::phantom
