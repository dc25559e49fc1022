#include "fluoroscopy/fluoroscope.h"

#include <cmath>
#include <utility>

#include "common/error.h"
#include "fluoroscopy/image/detector.h"

namespace endovascular_sim::fluoroscopy
{

Fluoroscope::Fluoroscope(const CArmPose& pose, const XRayScene& scene) : geometry_(pose), scene_(scene)
{
  for (const double value : {scene.tissue_attenuation, scene.vessel_attenuation, scene.tissue_thickness})
    if (!std::isfinite(value) || value < 0.0)
      throw InputError("X-ray scene", "attenuation, thickness", "must be non-negative");
}

void Fluoroscope::setPose(const CArmPose& pose)
{
  if (pose == geometry_.pose())
    return;
  const XRayGeometry geometry(pose);
  requireVesselInFrontOfSource(geometry, vessel_);
  geometry_ = geometry;
  background_valid_ = false;
}

void Fluoroscope::setVessel(geometry::TriangleMesh mesh)
{
  requireVesselInFrontOfSource(geometry_, mesh);
  vessel_ = std::move(mesh);
  background_valid_ = false;
}

void Fluoroscope::renderBackground()
{
  background_ = vesselPathLength(geometry_, vessel_);
  const int n = geometry_.pixels();
  background_frame_.pixels = n;
  background_frame_.raw.resize(background_.size());
  background_frame_.image.resize(background_.size());
  const double vessel = scene_.vessel_attenuation - scene_.tissue_attenuation;
  const double slab = scene_.tissue_attenuation * scene_.tissue_thickness;
  std::size_t k = 0;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column, ++k)
    {
      background_[k] = std::exp(-slab * (geometry_.ray(column, row).norm() - 1.0) - vessel * background_[k]);
      background_frame_.raw[k] = Detector::signal(background_[k]);
      background_frame_.image[k] = Detector::grey(background_[k], 1.0);
    }
  background_valid_ = true;
}

const Frame& Fluoroscope::render(const std::vector<XRayWire>& wires)
{
  if (!background_valid_)
    renderBackground();
  wire_projection_.project(geometry_, wires, shadow_);
  frame_ = background_frame_;
  for (std::size_t i = 0; i < shadow_.pixels.size(); ++i)
  {
    const std::size_t k = shadow_.pixels[i];
    frame_.raw[k] = Detector::signal(background_[k] * shadow_.transmission[i]);
    frame_.image[k] = Detector::grey(background_[k], shadow_.transmission[i]);
  }
  return frame_;
}

}  // namespace endovascular_sim::fluoroscopy
