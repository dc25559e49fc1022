#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/progress.h"
#include "contact/wall_model.h"
#include "flow/coupling/flow_engine.h"
#include "fluoroscopy/patient/volume_projection.h"
#include "procedure/branch_locator.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
#include "simulation/blood_coupling.h"
#include "simulation/motion_coupling.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::session
{

/** Patient of the X-ray image of a scene. */
struct XRayVolume
{
  std::shared_ptr<const fluoroscopy::VolumeProjection> projection;  ///< null: the scene has no patient
  std::vector<std::string> notes;                                   ///< origin and placement, for the log
};

/** Scene with all that follows from it and never changes: vessel, prepared wall, pose of the introducer, branches,
 *  patient of the X-ray image. Any number of sessions share a world, also in different threads. */
class World
{
public:
  /** @param scene path of a scene file, or the name of one in the package's config/scenes, e.g. "tube"
   *  @param overrides texts `key.path=value`, applied in order
   *  @param progress receives the progress of the preparation of large meshes
   *  @throws InputError when the scene or its vessel is refused */
  static std::shared_ptr<const World> open(const std::string& scene, const std::vector<std::string>& overrides = {},
                                           const ProgressReport& progress = {});

  /** World of the text of a scene.
   *  @param origin name of the text in errors; relative paths are searched next to it
   *  @throws InputError as open() */
  static std::shared_ptr<const World> parse(const std::string& yaml, const std::string& origin = "scene",
                                            const std::vector<std::string>& overrides = {},
                                            const ProgressReport& progress = {});

  /** World of a loaded scene.
   *  @param prepared receives the vessel, with its warnings and notes, before the first check that may refuse its use
   *  @throws InputError as open() */
  static std::shared_ptr<const World> make(scene::Scene scene, const ProgressReport& progress = {},
                                           const std::function<void(const vessel::Vessel&)>& prepared = {});

  /** World of a loaded scene with a given vessel, e.g. that of a recording. The wall is prepared by its first use.
   *  @param vessel empty for a scene without one
   *  @throws InputError when the entry or an initial insertion does not fit the vessel */
  static std::shared_ptr<const World> make(scene::Scene scene, std::optional<vessel::Vessel> vessel);

  /** World of a loaded scene with given parts, e.g. to vary the scene of a vessel.
   *  @param vessel not null
   *  @param wall of the vessel's mesh, with the shape of the scene's wall
   *  @param entry pose of the introducer, which replaces that of the scene
   *  @throws std::invalid_argument for a missing part, or a scene without a vessel */
  static std::shared_ptr<const World> make(scene::Scene scene, std::shared_ptr<const vessel::Vessel> vessel,
                                           std::shared_ptr<const contact::WallModel> wall,
                                           const scene::EntryPose& entry);

  /** World of another scene with the same vessel, e.g. with other instruments, friction or sampling. It shares vessel
   *  and wall with this one, and has the same entry.
   *  @throws std::invalid_argument unless both scenes have a vessel
   *  @throws InputError if an instrument would penetrate the wall at the start */
  std::shared_ptr<const World> with(scene::Scene scene) const;

  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const scene::Scene& scene() const { return scene_; }

  /** Undeformed vessel; null without one. */
  const vessel::Vessel* vessel() const { return vessel_.get(); }

  /** Content hash of the vessel's mesh; 0 without a vessel. */
  std::uint64_t meshHash() const { return mesh_hash_; }

  /** Wall prepared for contact detection; null without a vessel. */
  const std::shared_ptr<const contact::WallModel>& wall() const;

  /** Pose of the introducer, or of the proximal end without one. */
  const scene::EntryPose& entry() const { return entry_; }

  /** Branches of the vessel with the procedure's names, prepared by the first call; none without a centreline. */
  const std::shared_ptr<const procedure::BranchLocator>& branches() const;

  /** Flow of blood at the beginning, prepared by the first call.
   *  @throws std::logic_error for a scene without the key `flow`
   *  @throws InputError for a vessel whose centreline is no tree */
  const flow::FlowEngine& flow() const;

  /** Lumen of the vessel in cells of contrast medium, prepared by the first call.
   *  @throws std::logic_error for a scene without the key `contrast`
   *  @throws InputError as flow() */
  const simulation::ContrastVessel& contrastVessel() const;

  /** Parts of that lumen. */
  const std::shared_ptr<const contrast::LumenCells>& lumen() const { return contrastVessel().lumen; }

  /** Tree of the vessel for couplings with the flow; as flow(). */
  std::shared_ptr<const simulation::BloodVessel> bloodVessel() const;

  /** Motion of the patient at rest, prepared by the first call.
   *  @throws std::logic_error for a scene without the key `motion`
   *  @throws InputError for a vessel in which the heart is not found, a motion that folds space, or an introducer that
   *          would move */
  const simulation::PatientMotion& motion() const;

  /** Patient of the X-ray image, loaded by the first call.
   *  @throws InputError when the patient cannot be loaded; a further call tries again */
  const XRayVolume& patient() const;

  /** Checks the initial insertions of a scene that differs from this one's in its drives only.
   *  @throws InputError if an instrument would penetrate the wall at the start */
  void requireStart(const scene::Scene& scene) const;

private:
  World(scene::Scene scene, std::optional<vessel::Vessel> vessel);
  World(scene::Scene scene, std::shared_ptr<const vessel::Vessel> vessel,
        std::shared_ptr<const contact::WallModel> wall, const scene::EntryPose& entry);

  scene::Scene scene_;
  std::shared_ptr<const vessel::Vessel> vessel_;  ///< null without one
  std::uint64_t mesh_hash_ = 0;
  scene::EntryPose entry_;
  mutable std::shared_ptr<const contact::WallModel> wall_;
  mutable std::once_flag wall_prepared_, branches_known_, patient_loaded_, free_length_known_, flow_known_, tree_known_,
      motion_known_, contrast_known_;
  mutable std::shared_ptr<const procedure::BranchLocator> branches_;
  mutable std::unique_ptr<const flow::FlowEngine> flow_;
  mutable std::shared_ptr<const simulation::BloodVessel> blood_vessel_;
  mutable std::unique_ptr<const simulation::ContrastVessel> contrast_vessel_;
  mutable std::unique_ptr<const simulation::PatientMotion> motion_;
  mutable XRayVolume patient_;
  mutable double free_length_ = 0.0;  ///< from the entry to the wall along its direction [m]
};

}  // namespace endovascular_sim::session
