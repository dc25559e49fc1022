#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/gantry/gantry.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "nodes/fluoroscopy/body_motion_history.h"
#include "simulation/fluoroscopy_system.h"
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

  /** Sets the centreline of the vessel at rest, about which the patient is placed. */
  void setCentreline(vessel::CentrelineTree centreline) { vessel_.centreline = std::move(centreline); }

  /** Sets the instruments.
   *  @param nodes of the centreline, from proximal to distal [m]
   *  @param step of the simulation; the patient is drawn in the motion of this step
   *  @throws InputError as setVessel(); the instruments are set then, too */
  void setWires(std::vector<fluoroscopy::XRayWire> wires, const std::vector<Eigen::Vector3d>& nodes,
                std::uint64_t step = 0);

  /** Takes the motion of the patient in a step. */
  void setMotion(std::uint64_t step, const fluoroscopy::BodyMotion& motion) { motions_.add(step, motion); }

  /** Sets balloons and stents, with the vessel at rest. */
  void setTreatment(std::vector<fluoroscopy::XRayWire> treatment) { treatment_ = std::move(treatment); }

  bool awaitsVessel() const { return scene_.vessel && !has_mesh_; }  ///< the mesh has not arrived
  bool awaitsPatient() const { return needs_patient_; }              ///< the patient is not loaded

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
   *  @param display true: with the image for the display */
  const fluoroscopy::Frame& render(bool display);

  const simulation::FluoroscopySystem& system() const { return system_; }

private:
  void placePatient(const Eigen::Vector3d& isocentre);
  void applyPose();

  scene::Scene scene_;
  simulation::FluoroscopySystem system_;
  fluoroscopy::Fluoroscope& fluoroscope_;
  fluoroscopy::Gantry gantry_;
  std::vector<fluoroscopy::XRayWire> wires_, treatment_, shown_;
  std::uint64_t step_ = 0;  ///< of wires_
  BodyMotionHistory motions_;
  std::optional<Eigen::Vector3d> tip_;  ///< tip of the instrument that reaches farthest [m]
  bool has_mesh_ = false;
  vessel::Vessel vessel_;  ///< vessel at rest, about which the patient is placed; empty afterwards
  bool needs_patient_;     ///< true: the scene has a patient that is not yet loaded
  bool isocentre_known_;
};

}  // namespace endovascular_sim::nodes
