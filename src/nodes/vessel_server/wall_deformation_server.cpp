#include "nodes/vessel_server/wall_deformation_server.h"

#include <mutex>
#include <stdexcept>

#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "simulation/wall_state.h"

namespace endovascular_sim::nodes
{
namespace
{

using Guard = std::lock_guard<PriorityInheritanceMutex>;

void move(geometry::TriangleMesh& mesh, const WallDisplacement& displacement)
{
  for (std::size_t k = 0; k < displacement.index.size(); ++k)
    mesh.vertices[displacement.index[k]] = fromMessage(displacement.position[k]);
}

}  // namespace

WallDeformationServer::WallDeformationServer(const vessel::Vessel& vessel)
  : opening_(vessel, intervention::DilatationLaw{}), base_(vessel.mesh), initial_(save(history_.base()))
{
}

bool WallDeformationServer::press(const BalloonLoad& load, WallDisplacement& displacement)
{
  const Guard pressing(opening_mutex_);  // nobody else changes the history
  if (load.version != history_.newest() + 1)
    return false;
  toMessage(opening_.applyLoad(loadFromMessage(load), simulation::kMostDisplacedVertices), displacement);
  displacement.step = load.step;
  displacement.version = load.version;
  displacement.at_risk = opening_.atRisk();
  const Guard lock(mutex_);
  const std::uint64_t newest = history_.append(displacement);
  if (newest > history_.base() + simulation::kWallLag)
    history_.advanceTo(newest - simulation::kWallLag,
                       [this](std::uint64_t /*version*/, const WallDisplacement& passed) { move(base_, passed); });
  return true;
}

WallDeformationServer::Snapshot WallDeformationServer::snapshot() const
{
  Snapshot now;
  now.mesh.triangles = base_.triangles;  // constant, hence without the lock
  now.mesh.vertices.reserve(base_.vertices.size());
  const Guard lock(mutex_);
  now.version = history_.base();
  now.mesh.vertices = base_.vertices;
  for (const auto& version : history_.pending())
    now.displacements.push_back(version.displacement);
  return now;
}

std::uint64_t WallDeformationServer::version() const
{
  const Guard lock(mutex_);
  return history_.newest();
}

std::uint64_t WallDeformationServer::base() const
{
  const Guard lock(mutex_);
  return history_.base();
}

bool WallDeformationServer::atRisk() const
{
  const Guard lock(opening_mutex_);
  return opening_.atRisk();
}

std::string WallDeformationServer::save(std::uint64_t detected)
{
  const Guard pressing(opening_mutex_);
  return stateAt(detected);
}

/** As save(), with opening_mutex_ locked. */
std::string WallDeformationServer::stateAt(std::uint64_t detected)
{
  if (detected < history_.base() || detected > history_.newest())
    throw std::invalid_argument("WallDeformationServer: version " + std::to_string(detected) + " is not between " +
                                std::to_string(history_.base()) + " and " + std::to_string(history_.newest()));
  simulation::WallHistory<WallDisplacement> history = history_;
  geometry::TriangleMesh mesh = base_;
  history.advanceTo(detected,
                    [&mesh](std::uint64_t /*version*/, const WallDisplacement& passed) { move(mesh, passed); });
  simulation::WallHistory<intervention::WallDisplacement> later;
  later.restartAt(detected);
  for (const auto& version : history.pending())
    later.append(fromMessage(version.displacement, mesh.vertices.size()));
  intervention::WallDisplacement moved = intervention::displacementBetween(opening_.initialVertices(), mesh.vertices);
  return simulation::wallState(opening_, later, moved);
}

void WallDeformationServer::load(const std::string& state)
{
  const Guard pressing(opening_mutex_);
  const std::string before = stateAt(history_.base());
  try
  {
    adopt(state);
  }
  catch (...)
  {
    adopt(before);
    throw;
  }
}

void WallDeformationServer::adopt(const std::string& state)
{
  simulation::WallHistory<intervention::WallDisplacement> versions;
  intervention::WallDisplacement detected;
  simulation::loadWallState(state, opening_, versions, detected);
  const Guard lock(mutex_);
  base_.vertices = opening_.initialVertices();
  intervention::move(detected, base_.vertices);
  history_.restartAt(versions.base());
  for (const auto& version : versions.pending())
  {
    WallDisplacement message;
    toMessage(version.displacement, message);
    message.version = version.version;
    message.at_risk = opening_.atRisk();
    history_.append(std::move(message));
  }
}

}  // namespace endovascular_sim::nodes
