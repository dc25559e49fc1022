#include "simulation/local_deformable_wall.h"

#include <algorithm>

#include "common/archive.h"

namespace endovascular_sim::simulation
{

LocalDeformableWall::LocalDeformableWall(const vessel::Vessel& vessel, contact::Detector& detector)
  : opening_(vessel, intervention::DilatationLaw{}), detector_(detector)
{
}

std::uint64_t LocalDeformableWall::applyLoad(std::uint64_t /*step*/, const intervention::BalloonLoad& load)
{
  return history_.append(opening_.applyLoad(load, kMostDisplacedVertices));
}

void LocalDeformableWall::activate(std::uint64_t version)
{
  history_.advanceTo(version, [this](std::uint64_t passed, const intervention::WallDisplacement& displacement)
                     { detector_.moveVertices(displacement.indices, displacement.positions, passed); });
}

/** Displacement of the detector's wall from the initial vertices; the detector lags behind the opening. */
intervention::WallDisplacement LocalDeformableWall::detectedDisplacement() const
{
  intervention::WallDisplacement detected;
  const std::vector<Eigen::Vector3d>& vertices = detector_.wall().vertices;
  const std::vector<Eigen::Vector3d>& initial = opening_.initialVertices();
  for (std::size_t v = 0; v < initial.size(); ++v)
    if (vertices[v] != initial[v])
    {
      detected.indices.push_back(static_cast<int>(v));
      detected.positions.push_back(vertices[v]);
    }
  return detected;
}

void LocalDeformableWall::archive(Archive& archive)
{
  intervention::WallDisplacement detected = detectedDisplacement();
  if (archive.reading())
  {
    for (std::size_t k = 0; k < detected.indices.size(); ++k)
      detected.positions[k] = opening_.initialVertices()[static_cast<std::size_t>(detected.indices[k])];
    detector_.moveVertices(detected.indices, detected.positions, history_.base());
  }
  archive(opening_, history_, detected);
  if (!archive.reading())
    return;
  const std::size_t vertices = opening_.initialVertices().size();
  intervention::requireFit(detected, vertices);
  for (const auto& pending : history_.pending())
    intervention::requireFit(pending.displacement, vertices);
  detector_.moveVertices(detected.indices, detected.positions, history_.base());
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
