#pragma once

#include "fluoroscopy/motion/body_motion.h"
#include "fluoroscopy/projection/areal_density_image.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Body around the vessel in a sequence of frames. */
class Patient
{
public:
  virtual ~Patient() = default;

  /** Areal densities along each pixel's central ray for the next frame at this geometry, with geometry.pixels() samples
   * per side. Valid until the next call. */
  virtual const ArealDensityImage& frame(const XRayGeometry& geometry) = 0;

  /** Brings the image at this geometry to its final resolution at once. A phantom has no other one. */
  virtual void complete(const XRayGeometry& /*geometry*/) {}

  /** True if the last frame had the final resolution. */
  virtual bool isComplete() const { return true; }

  /** Moves heart and lungs, from the next frame on. A phantom does not move. */
  virtual void setMotion(const BodyMotion& /*motion*/) {}

  /** Number of changes of the image; equal numbers mean equal images, so that what follows from them can be kept. */
  virtual int revision() const = 0;

  /** Density of soft tissue that the body contains in the lumen of the vessel [kg/m³]. Blood replaces it. */
  virtual double lumenDensity() const = 0;
};

/** Slab of soft tissue normal to the central ray at every angle, as a water phantom. */
class SlabPatient : public Patient
{
public:
  /** @param thickness [m]
   *  @param density density of the tissue [kg/m³] */
  SlabPatient(double thickness, double density) : thickness_(thickness), density_(density) {}

  const ArealDensityImage& frame(const XRayGeometry& geometry) override;
  int revision() const override { return revision_; }
  double lumenDensity() const override { return density_; }

private:
  double thickness_;  ///< [m]
  double density_;    ///< [kg/m³]
  CArmPose pose_;
  int revision_ = 0;  ///< 0: no image yet
  ArealDensityImage image_;
};

}  // namespace endovascular_sim::fluoroscopy
