#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "contact/detector.h"
#include "intervention/deformable_wall.h"
#include "scene/model/scene.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Largest number of vertices that move in one round: contact detection updates them at once. */
constexpr std::size_t kMostMovedVertices = 200;

/** Wall of a vessel that balloons deform, and the detector that uses it, in this process. */
class LocalDeformableWall : public intervention::DeformableWall
{
public:
  /** @param vessel the same as that of the detector
   *  @param detector must outlive this */
  LocalDeformableWall(const vessel::Vessel& vessel, contact::Detector& detector);

  std::uint64_t press(std::uint64_t step, const intervention::BalloonLoad& pressing) override;
  void show(std::uint64_t version) override;
  std::uint64_t version() const override { return version_; }
  bool atRisk() const override { return opening_.atRisk(); }

  const intervention::VesselOpening& opening() const { return opening_; }

  void archive(Archive& archive) override;

private:
  struct Change
  {
    std::uint64_t version = 0;
    intervention::WallDisplacement moved;

    void archive(Archive& archive);
  };

  intervention::WallDisplacement shownDisplacement() const;

  intervention::VesselOpening opening_;
  contact::Detector& detector_;
  std::uint64_t version_ = 1;
  std::uint64_t shown_ = 1;     ///< version in the detector
  std::deque<Change> waiting_;  ///< displacements that are not in the detector yet
};

/** True when an instrument of the scene has a balloon, which deforms the wall. */
bool hasBalloon(const scene::Scene& scene);

/** Deformable wall of a scene; null where no instrument has a balloon. Parameters as of LocalDeformableWall. */
std::unique_ptr<LocalDeformableWall> makeLocalDeformableWall(const scene::Scene& scene, const vessel::Vessel& vessel,
                                                             contact::Detector& detector);

}  // namespace endovascular_sim::simulation
