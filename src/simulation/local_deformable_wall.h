#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "contact/detector.h"
#include "intervention/deformable_wall.h"
#include "intervention/vessel_dilatation.h"
#include "scene/model/scene.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Vertices that may move in one pressing: what contact must take up at once. */
constexpr std::size_t kMostMovedVertices = 200;

/** The wall of a vessel that balloons move, and the detector that searches it, in this process. */
class LocalDeformableWall : public intervention::DeformableWall
{
public:
  /** @param vessel as the detector has it
   *  @param detector must outlive this */
  LocalDeformableWall(const vessel::Vessel& vessel, contact::Detector& detector);

  std::uint64_t applyLoad(std::uint64_t step, const intervention::BalloonLoad& pressing) override;
  void activate(std::uint64_t version) override;
  std::uint64_t version() const override { return version_; }
  bool atRisk() const override { return opening_.atRisk(); }

  const intervention::VesselDilatation& opening() const { return opening_; }

  void archive(Archive& archive) override;

private:
  struct Change
  {
    std::uint64_t version = 0;
    intervention::WallDisplacement moved;

    void archive(Archive& archive);
  };

  intervention::VesselDilatation opening_;
  contact::Detector& detector_;
  std::uint64_t version_ = 1;
  std::uint64_t shown_ = 1;     ///< that contact searches
  std::deque<Change> waiting_;  ///< that contact does not search yet
};

/** Whether any instrument can move a wall. */
bool hasBalloon(const scene::Scene& scene);

/** The moving wall of a scene; null where no instrument has a balloon. Parameters as of LocalDeformableWall. */
std::unique_ptr<LocalDeformableWall> makeLocalDeformableWall(const scene::Scene& scene, const vessel::Vessel& vessel,
                                                             contact::Detector& detector);

}  // namespace endovascular_sim::simulation
