#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/patient/volume/density_volume.h"
#include "image/volume.h"

namespace endovascular_sim::phantom
{

enum class Tissue
{
  kAir,
  kLung,
  kFat,
  kSoftTissue,
  kMyocardium,
  kLeftVentricle,
  kRightVentricle,
  kLeftAtrium,
  kPulmonaryTrunk,
  kVein,
  kCortex,
  kWall,
  kLumen,
  kCalcium,
};

/** Value of a tissue in an image: Hounsfield units of a CT angiogram, or the signal of a magnetic resonance angiogram.
 * The signal of the lumen falls towards the feet.
 *  @param height of the point above the aortic bifurcation [m] */
double tissueValue(Tissue tissue, image::Modality modality, double height);

/** Value of a voxel of the body: the CT number of its density, or the signal of the tissue that has it. */
double bodyValue(const fluoroscopy::Density& density, image::Modality modality, double height);

/** Region of one tissue. Regions are drawn in the order of a list, each over the earlier ones. */
struct TissuePart
{
  Tissue tissue = Tissue::kAir;
  /** Signed distance to the region's surface, negative inside [m]. Its Lipschitz constant is at most 1, so that it is
   *  also a bound of the distance. */
  std::function<double(const Eigen::Vector3d&)> distance;
};

}  // namespace endovascular_sim::phantom
