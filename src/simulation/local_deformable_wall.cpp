#include "simulation/local_deformable_wall.h"

#include <algorithm>

#include "common/archive.h"

namespace endovascular_sim::simulation
{

LocalDeformableWall::LocalDeformableWall(const vessel::Vessel& vessel, contact::Detector& detector)
  : opening_(vessel, intervention::DilatationLaw{}), detector_(detector)
{
}

std::uint64_t LocalDeformableWall::applyLoad(std::uint64_t /*step*/, const intervention::BalloonLoad& pressing)
{
  waiting_.push_back({++version_, opening_.applyLoad(pressing, kMostMovedVertices)});
  return version_;
}

void LocalDeformableWall::activate(std::uint64_t version)
{
  shown_ = version;
  for (; !waiting_.empty() && waiting_.front().version <= version; waiting_.pop_front())
    detector_.moveVertices(waiting_.front().moved.indices, waiting_.front().moved.positions, waiting_.front().version);
}

void LocalDeformableWall::Change::archive(Archive& archive)
{
  archive(version, moved.indices, moved.positions);
}

void LocalDeformableWall::archive(Archive& archive)
{
  // The detector lags behind the opening: its vertices are compared with those of the beginning.
  intervention::WallDisplacement moved;
  const std::vector<Eigen::Vector3d>& shown = detector_.wall().vertices;
  const std::vector<Eigen::Vector3d>& first = opening_.initialVertices();
  for (std::size_t v = 0; v < first.size() && !archive.reading(); ++v)
    if (shown[v] != first[v])
    {
      moved.indices.push_back(static_cast<int>(v));
      moved.positions.push_back(shown[v]);
    }
  archive(opening_, version_, shown_, waiting_, moved.indices, moved.positions);
  if (archive.reading())
    detector_.moveVertices(moved.indices, moved.positions, shown_);
}

bool hasBalloon(const scene::Scene& scene)
{
  return std::any_of(scene.instruments.begin(), scene.instruments.end(),
                     [](const scene::DrivenInstrument& driven) { return driven.instrument.balloon.has_value(); });
}

std::unique_ptr<LocalDeformableWall> makeLocalDeformableWall(const scene::Scene& scene, const vessel::Vessel& vessel,
                                                             contact::Detector& detector)
{
  return hasBalloon(scene) ? std::make_unique<LocalDeformableWall>(vessel, detector) : nullptr;
}

}  // namespace endovascular_sim::simulation
