#include "session/moving_wall.h"

#include <algorithm>

namespace endovascular_sim::session
{

MovingWall::MovingWall(const vessel::Vessel& vessel, contact::Detector& detector)
  : opening_(vessel, intervention::OpeningLaw{}), detector_(detector)
{
}

std::uint64_t MovingWall::press(std::uint64_t /*step*/, const intervention::Pressing& pressing)
{
  waiting_.push_back({++version_, opening_.press(pressing, kMostMovedVertices)});
  return version_;
}

void MovingWall::show(std::uint64_t version)
{
  for (; !waiting_.empty() && waiting_.front().version <= version; waiting_.pop_front())
    detector_.moveVertices(waiting_.front().moved.indices, waiting_.front().moved.positions, waiting_.front().version);
}

std::unique_ptr<MovingWall> makeMovingWall(const Scene& scene, const vessel::Vessel& vessel,
                                           contact::Detector& detector)
{
  const bool needed = std::any_of(scene.instruments.begin(), scene.instruments.end(),
                                  [](const DrivenInstrument& driven) { return driven.instrument.balloon.has_value(); });
  return needed ? std::make_unique<MovingWall>(vessel, detector) : nullptr;
}

}  // namespace endovascular_sim::session
