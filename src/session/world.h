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
#include "fluoroscopy/patient/volume_projection.h"
#include "procedure/branch_locator.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
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

  /** World of a loaded scene with a given vessel, e.g. that of a recording.
   *  @param vessel empty for a scene without one
   *  @throws InputError when the entry or an initial insertion does not fit the vessel */
  static std::shared_ptr<const World> make(scene::Scene scene, std::optional<vessel::Vessel> vessel);

  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const scene::Scene& scene() const { return scene_; }

  /** Undeformed vessel; null without one. */
  const vessel::Vessel* vessel() const { return vessel_ ? &*vessel_ : nullptr; }

  /** Content hash of the vessel's mesh; 0 without a vessel. */
  std::uint64_t meshHash() const { return mesh_hash_; }

  /** Wall prepared for contact detection; null without a vessel. */
  const std::shared_ptr<const contact::WallModel>& wall() const { return wall_; }

  /** Pose of the introducer, or of the proximal end without one. */
  const scene::EntryPose& entry() const { return entry_; }

  /** Branches of the vessel with the procedure's names; without branches where the vessel has no centreline. */
  const std::shared_ptr<const procedure::BranchLocator>& branches() const { return branches_; }

  /** Patient of the X-ray image, loaded by the first call.
   *  @throws InputError when the patient cannot be loaded; a further call tries again */
  const XRayVolume& patient() const;

  /** Checks the initial insertions of a scene that differs from this one's in its drives only.
   *  @throws InputError if an instrument would penetrate the wall at the start */
  void requireStart(const scene::Scene& scene) const;

private:
  World(scene::Scene scene, std::optional<vessel::Vessel> vessel, const ProgressReport& progress);

  scene::Scene scene_;
  std::optional<vessel::Vessel> vessel_;
  std::uint64_t mesh_hash_ = 0;
  scene::EntryPose entry_;
  std::shared_ptr<const contact::WallModel> wall_;
  std::shared_ptr<const procedure::BranchLocator> branches_;
  mutable std::once_flag patient_loaded_, free_length_known_;
  mutable XRayVolume patient_;
  mutable double free_length_ = 0.0;  ///< from the entry to the wall along its direction [m]
};

}  // namespace endovascular_sim::session
