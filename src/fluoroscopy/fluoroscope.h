#pragma once

#include <cstdint>
#include <vector>

#include "fluoroscopy/projection/vessel_projection.h"
#include "fluoroscopy/projection/wire_projection.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Attenuation of the patient: a tissue slab that contains the vessel. */
struct XRayScene
{
  double tissue_attenuation = 0.0;  ///< linear attenuation coefficient of tissue [1/m]
  double vessel_attenuation = 0.0;  ///< linear attenuation coefficient of the blood with contrast medium [1/m]
  double tissue_thickness = 0.0;    ///< thickness of the slab, which is normal to the central ray at every angle [m]
};

/** Square image in row-major order from the top left. */
struct Frame
{
  int pixels = 0;                   ///< pixels per side
  std::vector<std::uint16_t> raw;   ///< detector signal, linear in intensity
  std::vector<std::uint8_t> image;  ///< for display
};

/** Fluoroscopic image synthesis by the Beer–Lambert law along each pixel's ray through slab, vessel and wire,
 *
 *      I/I₀ = exp(−μ_tissue·(L_slab − D) − (μ_vessel − μ_tissue)·L_vessel) · ⟨exp(−Σ Δμ·L_wire)⟩,
 *
 *  with path lengths L, the slab's thickness D and the mean ⟨·⟩ over the pixel. Intensities are relative to the slab on
 *  the central ray (see Detector). The first factor, the background, is cached while pose and vessel are unchanged. */
class Fluoroscope
{
public:
  /** @throws InputError for an invalid pose or scene */
  Fluoroscope(const CArmPose& pose, const XRayScene& scene);

  /** Moves the C-arm.
   *  @throws InputError for an invalid pose; the current pose is retained */
  void setPose(const CArmPose& pose);

  /** Replaces the vessel; an empty mesh removes it.
   *  @throws InputError if the mesh extends to the source; the current vessel is retained */
  void setVessel(geometry::TriangleMesh mesh);

  const XRayGeometry& geometry() const { return geometry_; }
  const XRayScene& scene() const { return scene_; }

  /** Renders the background and @p wires. The frame is valid until the next call.
   *  @throws InputError for a wire with arrays of inconsistent size */
  const Frame& render(const std::vector<XRayWire>& wires);

private:
  void renderBackground();

  XRayGeometry geometry_;
  XRayScene scene_;
  geometry::TriangleMesh vessel_;
  bool background_valid_ = false;
  std::vector<double> background_;  ///< relative intensity without the wire [1]
  Frame background_frame_;
  Frame frame_;
  WireProjection wire_projection_;
  WireShadow shadow_;
};

}  // namespace endovascular_sim::fluoroscopy
