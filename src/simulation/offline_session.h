#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/progress.h"
#include "contact/detector.h"
#include "scene/model/scene.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::simulation
{

/** Simulation of a scene file with its vessel and contact detection in this process. Steps as fast as it can, and gives
 *  the same trajectory as `simulate` and the nodes, bit for bit. */
class OfflineSession
{
public:
  /** @param scene path of a scene file, or the name of one in the package's config/scenes, e.g. "tube"
   *  @param overrides `key.path=value` texts, applied in order
   *  @param progress receives the progress of the preparation of large meshes
   *  @throws InputError when the scene or its vessel is refused */
  explicit OfflineSession(const std::string& scene, const std::vector<std::string>& overrides = {},
                          const ProgressReport& progress = {});

  OfflineSession(const OfflineSession&) = delete;
  OfflineSession& operator=(const OfflineSession&) = delete;

  /** Advances one time step with the motion of the scene's drives. The scripted operator of a procedure is not part of
   *  this class: such a scene needs simulation().stepAll(commands). */
  void step();

  bool isOver() const;  ///< true once the scene's duration is simulated

  const scene::Scene& scene() const { return scene_; }
  const vessel::Vessel* vessel() const { return vessel_.get(); }         ///< undeformed; null without a vessel
  const contact::Detector* detector() const { return detector_.get(); }  ///< null without a vessel
  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }

private:
  scene::Scene scene_;
  std::unique_ptr<vessel::Vessel> vessel_;
  std::unique_ptr<contact::Detector> detector_;
  std::unique_ptr<LocalDeformableWall> wall_;  ///< null unless an instrument has a balloon
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace endovascular_sim::simulation
