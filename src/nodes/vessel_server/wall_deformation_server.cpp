#include "nodes/vessel_server/wall_deformation_server.h"

#include <mutex>

#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"

namespace endovascular_sim::nodes
{

bool WallDeformationServer::press(const BalloonLoad& load, WallDisplacement& displacement)
{
  if (load.version != history_.newest() + 1)  // no other thread changes it
    return false;
  toMessage(opening_.applyLoad(loadFromMessage(load), simulation::kMostDisplacedVertices), displacement);
  displacement.step = load.step;
  displacement.version = load.version;
  displacement.at_risk = opening_.atRisk();
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  const std::uint64_t newest = history_.append(displacement);
  if (newest > history_.base() + simulation::kWallLag)
    history_.advanceTo(newest - simulation::kWallLag,
                       [this](std::uint64_t /*version*/, const WallDisplacement& passed)
                       {
                         for (std::size_t k = 0; k < passed.index.size(); ++k)
                           base_.vertices[passed.index[k]] = fromMessage(passed.position[k]);
                       });
  return true;
}

WallDeformationServer::Snapshot WallDeformationServer::snapshot() const
{
  Snapshot now;
  now.mesh.triangles = base_.triangles;  // constant, hence without the lock
  now.mesh.vertices.reserve(base_.vertices.size());
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  now.version = history_.base();
  now.mesh.vertices = base_.vertices;
  for (const auto& version : history_.pending())
    now.displacements.push_back(version.displacement);
  return now;
}

std::uint64_t WallDeformationServer::version() const
{
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  return history_.newest();
}

}  // namespace endovascular_sim::nodes
