#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "contact/detector.h"
#include "intervention/deformable_wall.h"
#include "intervention/vessel_dilatation.h"
#include "scene/model/scene.h"
#include "simulation/wall_history.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::simulation
{

/** Deformable wall of a vessel in this process, together with the detector that searches it. */
class LocalDeformableWall : public intervention::DeformableWall
{
public:
  /** @param vessel the vessel that the detector was built from
   *  @param detector must outlive this object */
  LocalDeformableWall(const vessel::Vessel& vessel, contact::Detector& detector);

  std::uint64_t applyLoad(std::uint64_t step, const intervention::BalloonLoad& load) override;
  void activate(std::uint64_t version) override;
  std::uint64_t version() const override { return history_.newest(); }
  const geometry::TriangleMesh* mesh() const override { return &opening_.mesh(); }
  const std::vector<Eigen::Vector3d>* detected() override { return &detector_.wall().vertices; }
  bool atRisk() const override { return opening_.atRisk(); }

  std::string save() override;
  void load(const std::string& state) override;
  void reset() override { load(initial_); }

private:
  intervention::WallDisplacement detectedDisplacement() const;

  intervention::VesselDilatation opening_;
  contact::Detector& detector_;
  WallHistory<intervention::WallDisplacement> history_;  ///< its base is the version that the detector searches
  std::string initial_;                                  ///< state of the initial wall
};

/** True when an instrument of the scene has a balloon, which deforms the wall. */
bool hasBalloon(const scene::Scene& scene);

/** Creates the deformable wall of a scene; null without a balloon. Parameters as of LocalDeformableWall. */
std::unique_ptr<LocalDeformableWall> makeLocalDeformableWall(const scene::Scene& scene, const vessel::Vessel& vessel,
                                                             contact::Detector& detector);

}  // namespace endovascular_sim::simulation
