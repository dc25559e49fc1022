#include "nodes/support/wall_keeper.h"

#include "nodes/support/contact_conversions.h"
#include "nodes/support/vessel_conversions.h"
#include "session/moving_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::size_t kRecent = 2;  // versions that contact may lag behind, see session::Treatments

}  // namespace

bool WallKeeper::press(const VesselPressing& pressing, VesselMoved& answer)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (pressing.version != version_ + 1)
    return false;
  const intervention::MovedVertices& moved = opening_.press(pressingFromMessage(pressing), session::kMostMovedVertices);
  version_ = pressing.version;
  toMessage(moved, answer);
  answer.step = pressing.step;
  answer.version = version_;
  answer.at_risk = opening_.atRisk();
  recent_.push_back(answer);
  for (; recent_.size() > kRecent; recent_.pop_front())
    for (std::size_t k = 0; k < recent_.front().index.size(); ++k)
      base_.vertices[recent_.front().index[k]] = fromMessage(recent_.front().position[k]);
  return true;
}

WallKeeper::Snapshot WallKeeper::snapshot() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return {version_ - recent_.size(), base_, {recent_.begin(), recent_.end()}};
}

std::uint64_t WallKeeper::version() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return version_;
}

}  // namespace endovascular_sim::nodes
