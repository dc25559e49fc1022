#include "segmentation/labels/mask_repair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "segmentation/labels/mask_topology.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kWidestJoint = 2.0;      ///< gap between pieces that is closed, in voxels
constexpr double kSmallestJoined = 0.01;  ///< volume of a piece that is joined, relative to the vessel
constexpr double kNarrowTunnel = 1.6;     ///< radius of a hole that is noise, in voxels
constexpr double kTunnelShare = 0.5;      ///< largest radius of a tunnel, in radii of the vessel beside it

/** Piece of a mask. */
struct Piece
{
  std::vector<std::size_t> voxels;
};

std::vector<Piece> piecesOf(const VoxelMask& mask)
{
  std::vector<int> component;
  const std::vector<std::size_t> sizes = componentsOf(mask, 1, component);
  std::vector<Piece> pieces(sizes.size());
  for (std::size_t n = 0; n < component.size(); ++n)
    if (component[n] >= 0)
      pieces[static_cast<std::size_t>(component[n])].voxels.push_back(n);
  return pieces;
}

/** Voxel of a list with the largest value. */
std::size_t deepest(const std::vector<std::size_t>& voxels, const std::vector<float>& depth)
{
  std::size_t best = voxels.front();
  for (const std::size_t at : voxels)
    if (depth[at] > depth[best])
      best = at;
  return best;
}

/** Piece that is kept: the nearest to a wanted point, or else the largest. */
std::size_t keptPiece(const VoxelMask& mask, const std::vector<Piece>& pieces,
                      const std::vector<Eigen::Vector3d>& wanted)
{
  std::size_t kept = 0;
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    if (wanted.empty())
    {
      kept = pieces[p].voxels.size() > pieces[kept].voxels.size() ? p : kept;
      continue;
    }
    for (const std::size_t at : pieces[p].voxels)
      if (const double distance = (mask.centreOf(at) - wanted.front()).norm(); distance < nearest)
      {
        nearest = distance;
        kept = p;
      }
  }
  return kept;
}

/** Closes the gap between a piece and the vessel by a rod of voxels between their nearest ones, about as wide as the
 * piece there. */
void join(VoxelMask& mask, std::size_t from, const VoxelMask& vessel, double radius)
{
  std::size_t to = 0;
  double least = std::numeric_limits<double>::max();
  const Eigen::Vector3d begin = mask.centreOf(from);
  for (std::size_t n = 0; n < vessel.inside.size(); ++n)
    if (vessel.inside[n] != 0)
      if (const double distance = (mask.centreOf(n) - begin).squaredNorm(); distance < least)
      {
        least = distance;
        to = n;
      }
  const Eigen::Vector3d step = mask.centreOf(to) - begin;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(radius) + step.cwiseAbs();
  const Eigen::Vector3i reach = margin.cwiseQuotient(mask.spacing).array().ceil().cast<int>();
  const Eigen::Vector3i centre = mask.voxelOf(from);
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i)
      {
        const Eigen::Vector3i voxel = centre + Eigen::Vector3i(i, j, k);
        if ((voxel.array() < 2).any() || (voxel.array() >= mask.size.array() - 2).any())
          continue;
        const Eigen::Vector3d p = Eigen::Vector3d(i, j, k).cwiseProduct(mask.spacing);
        const double t = std::clamp(p.dot(step) / step.squaredNorm(), 0.0, 1.0);
        if ((p - t * step).norm() <= radius)
          mask.inside[mask.offset(voxel)] = 1;
      }
}

/** Joins near pieces of some size to the vessel, and removes the others. */
void keepOnePiece(VoxelMask& mask, const std::vector<Eigen::Vector3d>& wanted, MaskChanges& changes)
{
  const double widest = (kWidestJoint + 1.5) * mask.spacing.maxCoeff();  // between the centres
  for (bool joined = true; joined;)
  {
    joined = false;
    changes.islands.clear();
    const std::vector<Piece> pieces = piecesOf(mask);
    if (pieces.size() < 2)
      return;
    const std::size_t kept = keptPiece(mask, pieces, wanted);
    VoxelMask vessel(mask.size, mask.spacing, mask.first);
    for (const std::size_t at : pieces[kept].voxels)
      vessel.inside[at] = 1;
    const std::vector<float> depth = distancesFrom(mask, 0);
    const std::vector<float> distance = distancesFrom(vessel, 1);
    for (std::size_t p = 0; p < pieces.size() && !joined; ++p)
    {
      const std::vector<std::size_t>& voxels = pieces[p].voxels;
      if (p == kept)
        continue;
      const std::size_t nearest = *std::min_element(
          voxels.begin(), voxels.end(), [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
      const std::size_t middle = deepest(voxels, depth);
      const bool is_part =
          static_cast<double>(voxels.size()) >= kSmallestJoined * static_cast<double>(pieces[kept].voxels.size());
      if (is_part && distance[nearest] <= widest)
      {
        changes.joints.push_back(mask.centreOf(nearest));
        join(mask, nearest, vessel, std::max(0.7 * static_cast<double>(depth[middle]), mask.spacing.maxCoeff()));
        joined = true;
        continue;
      }
      changes.islands.push_back({voxels.size(), static_cast<double>(voxels.size()) * mask.voxelVolume(),
                                 distance[nearest], mask.centreOf(middle)});
    }
    if (!joined)
      mask = vessel;
  }
  std::stable_sort(changes.islands.begin(), changes.islands.end(),
                   [](const Island& a, const Island& b) { return a.voxels > b.voxels; });
}

void fillCavities(VoxelMask& mask, MaskChanges& changes)
{
  std::vector<int> component;
  const std::vector<std::size_t> sizes = componentsOf(mask, 0, component);
  if (sizes.size() < 2)
    return;
  changes.cavities += sizes.size() - 1;
  for (std::size_t n = 0; n < component.size(); ++n)
    if (component[n] > 0)  // the first voxel of the grid lies outside
    {
      mask.inside[n] = 1;
      ++changes.cavity_voxels;
    }
}

/** Least mask without handles that holds a mask: the outside grows from the frame of the grid. */
VoxelMask withoutTunnels(const VoxelMask& mask)
{
  VoxelMask outside = mask;
  for (std::uint8_t& value : outside.inside)
    value = value == 0 ? 1 : 0;
  std::vector<std::size_t> frame;
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
  {
    const Eigen::Vector3i voxel = mask.voxelOf(n);
    if ((voxel.array() == 0).any() || (voxel.array() == mask.size.array() - 1).any())
      frame.push_back(n);
  }
  VoxelMask result = grown(outside, frame, distancesFrom(mask, 1));
  for (std::uint8_t& value : result.inside)
    value = value == 0 ? 1 : 0;
  return result;
}

/** Closes a region around a tunnel by a ball: what no ball of the outside reaches becomes inside. */
void closeBy(VoxelMask& mask, const Eigen::Vector3i& centre, double ball, double reach)
{
  const Eigen::Vector3i wide =
      Eigen::Vector3d::Constant(reach + ball).cwiseQuotient(mask.spacing).array().ceil().cast<int>();
  const Eigen::Vector3i low = (centre - wide).cwiseMax(2);
  const Eigen::Vector3i high = (centre + wide).cwiseMin(mask.size - Eigen::Vector3i::Constant(3));
  VoxelMask box(high - low + Eigen::Vector3i::Ones(), mask.spacing, Eigen::Vector3d::Zero());
  for (std::size_t n = 0; n < box.inside.size(); ++n)
    box.inside[n] = mask.inside[mask.offset(low + box.voxelOf(n))];
  const std::vector<float> distance = distancesFrom(box, 1);
  VoxelMask balls = box;
  for (std::size_t n = 0; n < balls.inside.size(); ++n)
    balls.inside[n] = distance[n] > ball ? 1 : 0;
  const std::vector<float> to_balls = distancesFrom(balls, 1);
  const Eigen::Vector3d middle = (centre - low).cast<double>().cwiseProduct(mask.spacing);
  for (std::size_t n = 0; n < box.inside.size(); ++n)
    if (to_balls[n] > ball && (box.centreOf(n) - middle).norm() <= reach)
      mask.inside[mask.offset(low + box.voxelOf(n))] = 1;
}

/** Fills holes through the vessel that are narrow beside it. */
void fillTunnels(VoxelMask& mask, MaskChanges& changes)
{
  VoxelMask lids = withoutTunnels(mask);
  for (std::size_t n = 0; n < lids.inside.size(); ++n)
    lids.inside[n] = lids.inside[n] != 0 && mask.inside[n] == 0 ? 1 : 0;
  const std::vector<float> depth = distancesFrom(mask, 0);
  const std::vector<float> to_mask = distancesFrom(mask, 1);
  const double voxel = mask.spacing.maxCoeff();
  for (const Piece& lid : piecesOf(lids))
  {
    const std::size_t middle = deepest(lid.voxels, to_mask);
    const double radius = to_mask[middle];
    double lumen = 0.0;  // of the vessel around the lid
    const Eigen::Vector3d centre = mask.centreOf(middle);
    const double near = 3.0 * radius + 2.0 * voxel;
    for (std::size_t n = 0; n < mask.inside.size(); ++n)
      if (depth[n] > lumen && (mask.centreOf(n) - centre).norm() < near)
        lumen = depth[n];
    if (radius > std::max(kNarrowTunnel * voxel, kTunnelShare * lumen))
      continue;
    for (const std::size_t at : lid.voxels)
      mask.inside[at] = 1;
    closeBy(mask, mask.voxelOf(middle), radius + voxel, 2.0 * std::max(lumen, radius) + 2.0 * voxel);
    changes.tunnels.push_back(centre);
  }
}

}  // namespace

std::vector<Eigen::Vector3d> cutLoops(VoxelMask& mask)
{
  std::vector<Eigen::Vector3d> cuts;
  if (handlesOf(mask) == 0)
    return cuts;
  const std::vector<float> depth = distancesFrom(mask, 0);
  std::vector<std::size_t> all;
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
    if (mask.inside[n] != 0)
      all.push_back(n);
  if (all.empty())
    return cuts;
  const VoxelMask ball = grown(mask, {deepest(all, depth)}, depth);
  VoxelMask removed = mask;
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
    removed.inside[n] = mask.inside[n] != 0 && ball.inside[n] == 0 ? 1 : 0;
  for (const Piece& cut : piecesOf(removed))
    cuts.push_back(mask.centreOf(deepest(cut.voxels, depth)));
  mask = ball;
  return cuts;
}

MaskChanges repairMask(VoxelMask& mask, const std::vector<Eigen::Vector3d>& wanted)
{
  MaskChanges changes;
  keepOnePiece(mask, wanted, changes);
  fillCavities(mask, changes);
  if (handlesOf(mask) > 0)
  {
    fillTunnels(mask, changes);
    fillCavities(mask, changes);
    changes.cut_loops = cutLoops(mask);
  }
  return changes;
}

}  // namespace endovascular_sim::segmentation
