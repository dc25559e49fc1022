#pragma once

#include <memory>
#include <vector>

#include "contrast/lumen/lumen_cells.h"
#include "fluoroscopy/contrast/iodine_image.h"
#include "fluoroscopy/contrast/lumen_matrix.h"
#include "fluoroscopy/contrast/moving_lumen.h"
#include "fluoroscopy/projection/moving_vessel.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::fluoroscopy
{

/** Iodine along the rays through a vessel whose parts hold different concentrations.
 *
 *  At rest the path lengths in the parts are kept (LumenMatrix); in a vessel that moves, the parts that move are
 * projected in every frame (MovingLumen). Both give the same areal densities but for rounding. */
class ContrastProjection
{
public:
  /** Replaces the parts; null: none. */
  void setLumen(std::shared_ptr<const contrast::LumenCells> lumen);

  const contrast::LumenCells* lumen() const { return lumen_.get(); }

  /** The pose, or the wall at rest, has changed. */
  void reset();

  /** Computes the iodine along the rays. @pre lumen() fits the vessel's mesh
   *  @param vessel projected with this geometry and map
   *  @param concentrations of the cells [kg/m³]
   *  @throws InputError if the vessel extends to the source */
  void project(const XRayGeometry& geometry, const motion::MotionMap& map, const MovingVessel& vessel,
               const std::vector<double>& concentrations, IodineImage& image);

private:
  std::shared_ptr<const contrast::LumenCells> lumen_;
  LumenMatrix matrix_;
  bool matrix_is_current_ = false;
  MovingLumen moving_;
};

}  // namespace endovascular_sim::fluoroscopy
