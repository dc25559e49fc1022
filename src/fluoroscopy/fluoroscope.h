#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fluoroscopy/beam/device_response.h"
#include "fluoroscopy/beam/signal_table.h"
#include "fluoroscopy/image/collimator.h"
#include "fluoroscopy/image/detector_image.h"
#include "fluoroscopy/image/display.h"
#include "fluoroscopy/image/exposure_control.h"
#include "fluoroscopy/motion/body_motion.h"
#include "fluoroscopy/projection/coaxial_stack.h"
#include "fluoroscopy/projection/moving_vessel.h"
#include "fluoroscopy/projection/patient.h"
#include "fluoroscopy/projection/wire_projection.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::fluoroscopy
{

/** Technique and patient of an X-ray system. */
struct XRayScene
{
  BeamSettings beam;
  ExposureSettings exposure;
  DisplaySettings display;
  double tissue_thickness = 0.2;  ///< thickness of the slab of soft tissue, if no other patient is set [m]
  double iodine = 150.0;          ///< concentration of iodine in the vessel [mgI/ml]
  std::uint64_t seed = 0;         ///< of the noise
};

/** Square image in row-major order from the top left. */
struct Frame
{
  int pixels = 0;                   ///< pixels per side
  std::vector<std::uint16_t> raw;   ///< detector signal, linear in intensity
  std::vector<std::uint8_t> image;  ///< for display
  double tube_charge = 0.0;         ///< [mAs]
  double reference_kerma = 0.0;     ///< air kerma of the frame at the reference point [Gy]
  bool dose_limited = false;        ///< true: the air kerma rate limits the dose at the detector
};

/** X-ray system: frames of a patient with a vessel and instruments.
 *
 *  The areal densities of tissue, bone and iodine along each pixel's ray give the primary signal by SignalTable.
 * Instruments multiply it by their transmission (WireProjection). Exposure control, scatter, noise and blur follow
 * (ExposureControl, DetectorImage), and the display image (Display). The signal without instruments is cached while
 * pose, vessel, motion and the patient's image are unchanged. */
class Fluoroscope
{
public:
  /** @throws InputError for an invalid pose or scene, or a material that the library does not contain */
  Fluoroscope(const CArmPose& pose, const XRayScene& scene, const MaterialLibrary& library);

  /** Moves the C-arm.
   *  @throws InputError for an invalid pose; the current pose is retained */
  void setPose(const CArmPose& pose);

  /** Replaces the vessel at rest; an empty mesh removes it.
   *  @throws InputError if the mesh extends to the source; the current vessel is retained */
  void setVessel(geometry::TriangleMesh mesh);

  /** Replaces the patient, at first a SlabPatient of the scene's thickness. */
  void setPatient(std::unique_ptr<Patient> patient);

  /** Moves vessel and patient to a phase of heart and breath, from the next frame on. At first both are at rest. */
  void setMotion(const BodyMotion& motion);
  const BodyMotion& motion() const { return motion_; }

  const XRayGeometry& geometry() const { return geometry_; }
  const XRayScene& scene() const { return scene_; }

  /** Equivalent densities of materials in this beam. */
  const DeviceResponse& materials() const { return response_; }

  /** Fluids around instruments: the blood of the vessel with its iodine. */
  LocalFluids vesselFluids() const;

  /** Fluids around instruments without vessel: tissue. */
  LocalFluids tissueFluids() const;

  /** Renders one frame of a sequence. The frame is valid until the next call.
   *  @param display false: the display image is not drawn
   *  @throws InputError for a wire with arrays of inconsistent size */
  const Frame& render(const std::vector<XRayWire>& wires, bool display = true);

  /** Number of frames rendered. It selects the noise of the next frame. */
  std::uint64_t frames() const { return frames_; }

  /** Starts a new sequence: frame number 0, exposure and display without history. */
  void restart();

private:
  void updateBackground();
  double measuredSignal() const;

  XRayGeometry geometry_;
  XRayScene scene_;
  double blood_density_;  ///< density of the tissue that attenuates as blood [kg/m³]
  DeviceDensity tissue_;
  SignalTable table_;
  DeviceResponse response_;
  ExposureControl exposure_;
  Collimator collimator_;
  DetectorImage detector_;
  Display display_;
  std::unique_ptr<Patient> patient_;
  MovingVessel vessel_;
  BodyMotion motion_;

  bool vessel_is_current_ = false;  ///< the path lengths of vessel_ are those of pose, vessel and motion
  int patient_revision_ = 0;        ///< of the patient's image in background_
  bool background_valid_ = false;
  std::vector<float> background_;   ///< primary signal without instruments
  std::vector<float> weight_;       ///< variance weight [keV]
  std::vector<float> steel_slope_;  ///< effective coefficient of thin steel [m²/kg]
  CoarseImage background_mean_;
  double measured_ = 0.0;  ///< logarithm of the mean signal in the measuring field

  std::uint64_t frames_ = 0;
  Frame frame_;
  std::vector<float> signal_;
  WireProjection wire_projection_;
  WireShadow shadow_;
};

}  // namespace endovascular_sim::fluoroscopy
