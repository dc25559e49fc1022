#include "fluoroscopy/contrast/contrast_projection.h"

#include <algorithm>
#include <utility>

namespace endovascular_sim::fluoroscopy
{

void ContrastProjection::setLumen(std::shared_ptr<const contrast::LumenCells> lumen)
{
  moving_.setLumen(lumen);
  lumen_ = std::move(lumen);
  matrix_is_current_ = false;
}

void ContrastProjection::reset()
{
  matrix_is_current_ = false;
  moving_.reset();
}

void ContrastProjection::project(const XRayGeometry& geometry, const motion::MotionMap& map, const MovingVessel& vessel,
                                 const std::vector<double>& concentrations, IodineImage& image)
{
  image.clear();
  if (std::all_of(concentrations.begin(), concentrations.end(), [](double c) { return c == 0.0; }))
    return;
  const std::vector<double> parts = lumen_->partConcentrations(concentrations);
  if (!map.resting())
    return moving_.project(geometry, vessel, parts, image);
  if (!matrix_is_current_)
  {
    std::vector<Corner> corners;
    for (const Eigen::Vector3d& position : lumen_->place(vessel.mesh().vertices))
      corners.push_back(projectCorner(geometry, position));
    matrix_.build(geometry, *lumen_, corners);
    matrix_is_current_ = true;
  }
  matrix_.multiply(parts, image);
}

}  // namespace endovascular_sim::fluoroscopy
