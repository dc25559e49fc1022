#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "image/volume.h"
#include "phantom/phantom.h"

namespace endovascular_sim::phantom
{

/** Diseased vessel in its surroundings, with an exactly known lumen. Its axis runs along z through the origin. */
class DiseasedVessel
{
public:
  DiseasedVessel() = default;
  DiseasedVessel(const DiseasedVessel&) = delete;
  DiseasedVessel& operator=(const DiseasedVessel&) = delete;
  virtual ~DiseasedVessel() = default;

  /** Distance from the wall of the lumen, negative inside; exact to the first order [m]. */
  virtual double toWall(const Eigen::Vector3d& p) const = 0;

  /** Value of the image without point spread and noise: Hounsfield units, or a signal. */
  virtual double valueAt(const Eigen::Vector3d& p) const = 0;

  /** Two clicks into the lumen, one near each end [m]. */
  virtual std::vector<Eigen::Vector3d> clicks() const = 0;

  /** Half of the edges of a box around the origin that holds the vessel [m]. */
  virtual Eigen::Vector3d halfExtent() const = 0;

  /** Modality, voxels, point spread and noise of the usual image. */
  virtual PhantomSettings usualImage() const;
};

/** Names of the diseases. */
const std::vector<std::string>& diseaseNames();

/** Vessel with a disease, of a degree [usual one]:
 *  - aneurysm: aorta of 25 mm that widens, more to one side; largest diameter [0.06 m]
 *  - stenosis: artery of 3 mm with a lesion of 10 mm; share of the diameter that is missing [0.8]
 *  - dim_lumen: MR of a vessel of 21 mm, whose signal falls across it; darkest over brightest signal [0.35]
 *  - bone: artery of 4 mm beside bone; soft gap between wall and bone [0.0002 m]
 *  - dissection: aorta of 28 mm, from whose wall a flap of 1.2 mm peels off below an endograft; the false lumen is
 *    darker; distance of the flap from the axis in radii, positive for a narrow true lumen [−0.1]
 *  - crescent: the same with a flap that bulges into the true lumen [0.5]
 *
 *  @param degree NaN: the usual one
 *  @throws InputError for an unknown name, or a degree out of its range */
std::unique_ptr<DiseasedVessel> diseasedVessel(const std::string& name, double degree);

/** Image of a diseased vessel; voxels hold means over their volume. */
image::Volume imageOf(const DiseasedVessel& vessel, const PhantomSettings& settings,
                      const ProgressReport& progress = {});

}  // namespace endovascular_sim::phantom
