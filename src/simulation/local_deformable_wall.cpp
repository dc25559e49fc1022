#include "simulation/local_deformable_wall.h"

#include <algorithm>

#include "simulation/wall_state.h"

namespace endovascular_sim::simulation
{

LocalDeformableWall::LocalDeformableWall(const vessel::Vessel& vessel, contact::Detector& detector)
  : opening_(vessel, intervention::DilatationLaw{}), detector_(detector), initial_(save())
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
  return intervention::displacementBetween(opening_.initialVertices(), detector_.wall().vertices);
}

std::string LocalDeformableWall::save()
{
  intervention::WallDisplacement detected = detectedDisplacement();
  return wallState(opening_, history_, detected);
}

void LocalDeformableWall::load(const std::string& state)
{
  intervention::WallDisplacement detected = detectedDisplacement();
  for (std::size_t k = 0; k < detected.indices.size(); ++k)
    detected.positions[k] = opening_.initialVertices()[static_cast<std::size_t>(detected.indices[k])];
  detector_.moveVertices(detected.indices, detected.positions, history_.base());
  loadWallState(state, opening_, history_, detected);
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
