#pragma once

#include <vector>

#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Areal densities of a patient along each pixel's central ray [kg/m²], in row-major order from the top left. */
struct PatientImage
{
  std::vector<float> tissue;
  std::vector<float> bone;
};

/** Body around the vessel. */
class Patient
{
public:
  virtual ~Patient() = default;

  /** Projects the body; @p image is resized. */
  virtual void project(const XRayGeometry& geometry, PatientImage& image) const = 0;
};

/** Slab of soft tissue normal to the central ray at every angle, as a water phantom. */
class SlabPatient : public Patient
{
public:
  /** @param thickness [m]
   *  @param density density of the tissue [kg/m³] */
  SlabPatient(double thickness, double density) : areal_density_(thickness * density) {}

  void project(const XRayGeometry& geometry, PatientImage& image) const override;

private:
  double areal_density_;  ///< [kg/m²]
};

}  // namespace endovascular_sim::fluoroscopy
