#pragma once

#include <cstdint>
#include <vector>

#include "fluoroscopy/vessel_projection.h"
#include "fluoroscopy/wire_projection.h"
#include "fluoroscopy/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** What fills the field besides the wire. */
struct XRayScene
{
  double tissue_attenuation = 0.0;  ///< [1/m]
  double vessel_attenuation = 0.0;  ///< of what fills the vessel, blood with iodine [1/m]
  double tissue_thickness = 0.0;    ///< of the slab, held across the central ray at any angle of the C-arm [m]
};

/** One image, row by row from the top left. */
struct Frame
{
  int pixels = 0;                   ///< along each side
  std::vector<std::uint16_t> raw;   ///< detector signal, linear in intensity
  std::vector<std::uint8_t> image;  ///< for display
};

/** The X-ray system: Beer–Lambert along each pixel's ray through slab, vessel and wire,
 *
 *      I/I₀ = exp(−μ_tissue·(L_slab − D) − (μ_vessel − μ_tissue)·L_vessel) · mean over the pixel of exp(−Σ Δμ·L_wire),
 *
 *  with the slab's thickness D: intensities are relative to the slab on the central ray (see Detector). The part
 *  before the dot is kept as long as pose and vessel are the same; a frame only redraws the wire. */
class Fluoroscope
{
public:
  /** @throws InputError for an impossible pose or scene */
  Fluoroscope(const CArmPose& pose, const XRayScene& scene);

  /** Moves the C-arm. @throws InputError for an impossible pose, and then stays where it is */
  void setPose(const CArmPose& pose);

  /** Replaces the vessel; an empty mesh is no vessel.
   *  @throws InputError when it reaches the source, and then keeps the old one */
  void setVessel(geometry::TriangleMesh mesh);

  const XRayGeometry& geometry() const { return geometry_; }
  const XRayScene& scene() const { return scene_; }

  /** The image of everything and @p wires. The frame is valid until the next call.
   *  @throws InputError for a wire whose arrays do not fit together */
  const Frame& render(const std::vector<XRayWire>& wires);

private:
  void renderBackground();

  XRayGeometry geometry_;
  XRayScene scene_;
  geometry::TriangleMesh vessel_;
  bool background_valid_ = false;
  std::vector<double> background_;  // relative intensity without the wire [1]
  Frame background_frame_;
  Frame frame_;
  WireProjection wire_projection_;
  WireShadow shadow_;
};

}  // namespace endovascular_sim::fluoroscopy
