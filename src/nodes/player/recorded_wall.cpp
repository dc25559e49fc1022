#include "nodes/player/recorded_wall.h"

#include <algorithm>

#include "endovascular_sim/WallDisplacement.h"
#include "intervention/wall_displacement.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/session_bag.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::size_t kFirstSpacing = 32;  ///< displacements between two snapshots, as long as few are kept
constexpr std::size_t kSnapshotBytes = 32U * 1024U * 1024U;  ///< of all snapshots [B]

}  // namespace

RecordedWall::RecordedWall(const BagTimeline& timeline) : timeline_(timeline)
{
  for (const std::uint32_t entry : timeline.entriesOf({names::kVesselMesh, names::kWallDisplacement}))
  {
    const BagMessage& message = timeline.message(entry);
    try
    {
      if (isTopic(message.topic, names::kVesselMesh))
      {
        Origin origin;
        origin.mesh = entry;
        origin.version = message.read<VesselMesh>()->version;
        origins_.push_back(origin);
      }
      else if (!origins_.empty())
      {
        const std::uint64_t version = message.read<WallDisplacement>()->version;
        origins_.back().displacements.push_back(entry);
        origins_.back().versions.push_back(version);
      }
    }
    catch (const ros::Exception&)
    {
      continue;  // the bytes of the message are damaged; the timeline names them
    }
  }
}

const RecordedWall::Origin* RecordedWall::originAt(ros::Time time) const
{
  const Origin* found = nullptr;
  for (const Origin& origin : origins_)
    if (timeline_.entries()[origin.mesh].time <= time)
      found = &origin;
  return found;
}

std::size_t RecordedWall::displacementsAt(const Origin& origin, ros::Time time) const
{
  const auto later =
      std::upper_bound(origin.displacements.begin(), origin.displacements.end(), time,
                       [this](ros::Time at, std::uint32_t entry) { return at < timeline_.entries()[entry].time; });
  return static_cast<std::size_t>(later - origin.displacements.begin());
}

std::optional<std::uint64_t> RecordedWall::versionAt(ros::Time time) const
{
  const Origin* origin = originAt(time);
  if (origin == nullptr)
    return std::nullopt;
  const std::size_t count = displacementsAt(*origin, time);
  return count == 0 ? origin->version : origin->versions[count - 1];
}

std::optional<VesselMesh> RecordedWall::at(ros::Time time)
{
  const Origin* origin = originAt(time);
  if (origin == nullptr)
    return std::nullopt;
  const std::size_t count = displacementsAt(*origin, time);
  goTo(*origin, count);
  VesselMesh wall = message_;
  if (count == 0)
    return wall;
  wall.header.stamp = timeline_.entries()[origin->displacements[count - 1]].time;
  wall.version = origin->versions[count - 1];
  toMessage(mesh_, wall);
  return wall;
}

/** Moves the wall to a number of displacements of an origin, from the nearest known wall before it. */
void RecordedWall::goTo(const Origin& origin, std::size_t displacements)
{
  if (present_ != &origin)
  {
    present_ = nullptr;
    message_ = *timeline_.message(origin.mesh).read<VesselMesh>();
    mesh_ = fromMessage(message_);
    snapshots_.clear();
    snapshots_[0] = mesh_.vertices;
    spacing_ = kFirstSpacing;
    moved_ = 0;
    present_ = &origin;
  }
  const auto before = std::prev(snapshots_.upper_bound(displacements));
  if (displacements < moved_ || before->first > moved_)
  {
    mesh_.vertices = before->second;
    moved_ = before->first;
  }
  while (moved_ < displacements)
  {
    const auto moved = timeline_.message(origin.displacements[moved_]).read<WallDisplacement>();
    intervention::move(fromMessage(*moved, mesh_.vertices.size()), mesh_.vertices);
    ++moved_;
    keepSnapshot();
  }
}

/** Keeps the wall for later jumps. When there is no room, every other snapshot is dropped, and later ones are farther
 *  apart. */
void RecordedWall::keepSnapshot()
{
  if (moved_ < std::prev(snapshots_.end())->first + spacing_)
    return;
  snapshots_[moved_] = mesh_.vertices;
  const std::size_t bytes = std::max<std::size_t>(mesh_.vertices.size(), 1) * sizeof(Eigen::Vector3d);
  if (snapshots_.size() <= std::max<std::size_t>(kSnapshotBytes / bytes, 4))
    return;
  spacing_ *= 2;
  bool drops = false;
  for (auto snapshot = std::next(snapshots_.begin()); snapshot != snapshots_.end();)
  {
    drops = !drops;
    snapshot = drops ? snapshots_.erase(snapshot) : std::next(snapshot);
  }
}

}  // namespace endovascular_sim::nodes
