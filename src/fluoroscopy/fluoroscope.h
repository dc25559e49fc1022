#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fluoroscopy/beam/device_response.h"
#include "fluoroscopy/beam/signal_table.h"
#include "fluoroscopy/contrast/contrast_projection.h"
#include "fluoroscopy/contrast/iodine_image.h"
#include "fluoroscopy/image/collimator.h"
#include "fluoroscopy/image/detector_image.h"
#include "fluoroscopy/image/display.h"
#include "fluoroscopy/image/exposure_control.h"
#include "fluoroscopy/motion/body_motion.h"
#include "fluoroscopy/motion/phase_grid.h"
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
  double iodine = 150.0;          ///< even concentration of iodine in the vessel, without setContrast() [mgI/ml]
  std::uint64_t seed = 0;         ///< of the noise
};

/** Pulse of the tube: exposure and quality of a frame. */
struct Pulse
{
  std::uint64_t number = 0;           ///< selects the noise
  int detector = 0;                   ///< 0 or 1, of a biplane system; selects the noise
  std::optional<double> tube_charge;  ///< [mAs]; empty: that of the exposure control
  /** True: the patient has its final resolution, also in the first frame after a movement, and the recursive filter is
   *  off. */
  bool complete = false;
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
  bool complete = false;            ///< true: the patient has its final resolution
};

/** X-ray system: frames of a patient with a vessel and instruments.
 *
 *  A frame with the final resolution of the patient is a function of what is set here, of instruments and pulse alone;
 * only the recursive filter of the display remembers the frames before.
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

  /** Replaces the vessel at rest; an empty mesh removes it. A wall that has moved keeps parts and contrast of the
   *  lumen; another mesh loses them.
   *  @throws InputError if the mesh extends to the source; the current vessel is retained */
  void setVessel(geometry::TriangleMesh mesh);

  /** Sets the parts of the vessel's lumen, which hold contrast medium.
   *  @throws InputError for the parts of another vessel */
  void setLumen(std::shared_ptr<const contrast::LumenCells> lumen);

  /** Sets the contrast medium in the vessel, in place of an even one.
   *  @param concentrations of iodine in the cells of the lumen [mgI/ml]; empty: the even one of the scene
   *  @throws InputError if there is not one non-negative number for each cell */
  void setContrast(std::vector<double> concentrations);

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

  /** Blood with iodine. @param concentration [mgI/ml] */
  DeviceDensity blood(double concentration) const { return blood_ + concentration * iodine_; }

  /** Fluids around instruments without vessel: tissue. */
  LocalFluids tissueFluids() const;

  const Collimator& collimator() const { return collimator_; }  ///< of the present pose

  /** Overlay of the display image from the next frame on, e.g. a roadmap: Display::setOverlay(). */
  void setOverlay(std::vector<float> overlay) { display_.setOverlay(std::move(overlay)); }

  /** Sets the motions at which the tissue of the patient is drawn in a sequence, see PhaseGrid; null: at every motion.
   *  Vessel and instruments are drawn where they are in either case. */
  void setPhases(std::shared_ptr<const PhaseGrid> phases);

  /** Renders the frame of a pulse. It is valid until the next call.
   *  @param display false: the display image is not drawn
   *  @throws InputError for a wire with arrays of inconsistent size */
  const Frame& render(const std::vector<XRayWire>& wires, const Pulse& pulse, bool display = true);

  /** Renders the next frame of a sequence, whose pulses are counted from 0. */
  const Frame& render(const std::vector<XRayWire>& wires, bool display = true);

  /** Starts a new sequence: the next pulse is 0, display without history. */
  void restart();

private:
  /** Sum of the signal over pixels. */
  struct Sum
  {
    double value = 0.0;
    std::size_t pixels = 0;
  };

  /** Pixel of the background before contrast medium is drawn. */
  struct PlainPixel
  {
    std::size_t pixel = 0;
    float signal = 0.0F, weight = 0.0F, steel_slope = 0.0F;
  };

  void updateBackground(bool complete);
  void drawBackground(const ArealDensityImage& patient);
  void drawContrast(const ArealDensityImage& patient);
  void removeContrast();
  ArealDensities densitiesAt(const ArealDensityImage& patient, std::size_t pixel, double length) const;
  bool isMeasured(int row, int column) const;
  Sum measuredSignal() const;
  void setPatientMotion();

  XRayGeometry geometry_;
  XRayScene scene_;
  double blood_density_;                   ///< density of the tissue that attenuates as blood [kg/m³]
  DeviceDensity tissue_, blood_, iodine_;  ///< the last one of iodine with 1 kg/m³
  SignalTable table_;
  DeviceResponse response_;
  ExposureControl exposure_;
  Collimator collimator_;
  DetectorImage detector_;
  Display display_;
  std::unique_ptr<Patient> patient_;
  MovingVessel vessel_;
  BodyMotion motion_;
  std::shared_ptr<const PhaseGrid> phases_;  ///< null: the patient has the motion of the vessel

  bool vessel_is_current_ = false;  ///< the path lengths of vessel_ are those of pose, vessel and motion
  int patient_revision_ = 0;        ///< of the patient's image in background_
  bool background_valid_ = false;
  std::vector<float> background_;   ///< primary signal without instruments
  std::vector<float> weight_;       ///< variance weight [keV]
  std::vector<float> steel_slope_;  ///< effective coefficient of thin steel [m²/kg]
  CoarseImage plain_mean_, background_mean_;
  Sum plain_sum_;          ///< of the measuring field, without contrast medium
  double measured_ = 0.0;  ///< logarithm of the mean signal in the measuring field

  ContrastProjection contrast_;
  std::vector<double> concentrations_;  ///< of the cells [kg/m³]; empty: even
  bool contrast_is_current_ = false;    ///< concentrations_ are drawn
  IodineImage iodine_image_;
  std::vector<float> contrast_signal_;
  std::vector<PlainPixel> plain_pixels_;  ///< of those with contrast medium

  std::uint64_t frames_ = 0;  ///< of the sequence
  Frame frame_;
  std::vector<float> signal_;
  WireProjection wire_projection_;
  WireShadow shadow_;
};

}  // namespace endovascular_sim::fluoroscopy
