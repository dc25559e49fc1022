#include "nodes/vessel_server/wall_deformation_server.h"

#include <mutex>

#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::size_t kRecent = 2;  // versions that contact may lag behind, see simulation::BalloonTreatments

}  // namespace

bool WallDeformationServer::press(const BalloonLoad& pressing, WallDisplacement& answer)
{
  if (pressing.version != version_ + 1)  // which no other thread changes
    return false;
  toMessage(opening_.applyLoad(pressingFromMessage(pressing), simulation::kMostMovedVertices), answer);
  answer.step = pressing.step;
  answer.version = pressing.version;
  answer.at_risk = opening_.atRisk();
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  version_ = pressing.version;
  recent_.push_back(answer);
  for (; recent_.size() > kRecent; recent_.pop_front())
    for (std::size_t k = 0; k < recent_.front().index.size(); ++k)
      base_.vertices[recent_.front().index[k]] = fromMessage(recent_.front().position[k]);
  return true;
}

WallDeformationServer::Snapshot WallDeformationServer::snapshot() const
{
  Snapshot now;
  now.mesh.triangles = base_.triangles;  // which never change
  now.mesh.vertices.reserve(base_.vertices.size());
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  now.version = version_ - recent_.size();
  now.mesh.vertices = base_.vertices;
  now.moved.assign(recent_.begin(), recent_.end());
  return now;
}

std::uint64_t WallDeformationServer::version() const
{
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  return version_;
}

}  // namespace endovascular_sim::nodes
