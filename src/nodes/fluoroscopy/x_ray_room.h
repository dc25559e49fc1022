#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/angiography/angiography.h"
#include "fluoroscopy/gantry/gantry.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "nodes/fluoroscopy/pulse_states.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/imaged_bodies.h"
#include "vessel/model/lesion.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::nodes
{

/** X-ray room of a scene, independent of ROS: the system on its C-arm, the patient on the table, and the instruments in
 *  the image. */
class XRayRoom
{
public:
  /** @param scene scene with fluoroscopy */
  XRayRoom(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& library);

  // ------------------------------------------------------------------------------------------------ what is imaged

  /** Sets the wall at rest. Without an isocentre, its middle becomes the isocentre.
   *  @throws InputError when the C-arm cannot be there */
  void setVessel(geometry::TriangleMesh mesh);

  /** Sets the centreline of the vessel at rest, for the place of the patient and the cells of contrast medium.
   *  @throws InputError when it does not belong to the wall */
  void setCentreline(vessel::CentrelineTree centreline, std::vector<vessel::PlacedLesion> lesions);

  /** Takes the place of the instruments, which the table may follow.
   *  @param nodes of the centreline, from proximal to distal [m]
   *  @throws InputError as setVessel() */
  void follow(const std::vector<Eigen::Vector3d>& nodes);

  /** Sets what the next images show: instruments, balloons and stents, motion of the patient, contrast medium.
   *  @throws InputError for contrast medium of another vessel */
  void setState(const ImagedState& state);

  /** The mesh has not arrived, or the centreline that divides its lumen. */
  bool awaitsVessel() const { return scene_.vessel && (!has_mesh_ || needs_lumen_); }
  bool awaitsPatient() const { return needs_patient_; }  ///< the patient is not loaded
  /** The centreline is of use: for the patient or for contrast medium. */
  bool needsCentreline() const { return needs_patient_ || needs_lumen_; }

  /** True when the patient can be loaded: the scene has one, and its vessel is known. */
  bool canLoadPatient() const;

  /** Loads the patient. After a failure canLoadPatient() is false until the vessel arrives again.
   *  @param resolution empty: that of a sequence at the frame rate of the scene
   *  @return notes on its origin and placement
   *  @throws InputError when it cannot be loaded */
  std::vector<std::string> loadPatient(
      const std::optional<fluoroscopy::ProgressiveResolution>& resolution = std::nullopt);

  // ------------------------------------------------------------------------------------------------------ the C-arm

  /** Moves the C-arm to a pose at its speeds.
   *  @param names_isocentre false: the isocentre of the target is that of the present one
   *  @throws InputError for an invalid pose, which changes nothing */
  void moveTo(const fluoroscopy::CArmPose& target, bool names_isocentre);

  /** Moves C-arm and table, which follows the tip if the scene says so.
   *  @param duration [s]
   *  @throws InputError at a collision, where they stop */
  void advance(double duration);

  /** Places C-arm and table at a pose without motion, e.g. at the recorded one.
   *  @throws InputError when they cannot be there; they stay where they are */
  void placeAt(const fluoroscopy::CArmPose& pose);

  const fluoroscopy::Gantry& gantry() const { return gantry_; }
  const fluoroscopy::XRayGeometry& geometry() const { return fluoroscope_.geometry(); }

  // ---------------------------------------------------------------------------------------------------------- images

  /** X-ray frame of the present state. @pre neither awaitsVessel() nor awaitsPatient()
   *  @param pulse its number, which selects the noise
   *  @param display true: with the image for the display */
  const fluoroscopy::AngiographyFrame& draw(std::uint64_t pulse, bool display);

  /** Modes, mask and last frame. @{ */
  fluoroscopy::Angiography& angiography() { return angiography_; }
  const fluoroscopy::Angiography& angiography() const { return angiography_; }
  /** @} */

  const simulation::FluoroscopySystem& system() const { return system_; }

private:
  void divideLumen();
  std::vector<fluoroscopy::XRayWire> wiresOf(const simulation::ImagedTreatment& treatment) const;
  void placePatient(const Eigen::Vector3d& isocentre);
  void applyPose();

  scene::Scene scene_;
  simulation::FluoroscopySystem system_;
  fluoroscopy::Fluoroscope& fluoroscope_;
  fluoroscopy::Angiography angiography_;
  fluoroscopy::Gantry gantry_;
  std::vector<fluoroscopy::XRayWire> wires_;  ///< of the present state, in the moved patient
  bool draws_stills_ = false;                 ///< the patient is drawn at every motion exactly
  std::optional<Eigen::Vector3d> tip_;        ///< tip of the instrument that reaches farthest [m]
  bool has_mesh_ = false;
  vessel::Vessel vessel_;  ///< vessel at rest, for patient and lumen; empty afterwards
  bool needs_patient_;     ///< true: the scene has a patient that is not yet loaded
  bool needs_lumen_;       ///< true: the scene has contrast medium, and its lumen is not yet divided
  bool isocentre_known_;
};

}  // namespace endovascular_sim::nodes
