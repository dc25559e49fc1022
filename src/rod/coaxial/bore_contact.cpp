#include "rod/coaxial/bore_contact.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kWallStiffness = 5e7;  // N/m² of the bore per length: 1 µm at 50 N/m
constexpr double kRestoring = 2e3;      // N/m² per length against the change of the shift in one solution
constexpr double kTolerance = 1e-8;     // m, error of a shift
constexpr int kMaxIterations = 100;
constexpr int kMaxHalvings = 20;
constexpr double kRounding = 1e-12;  // relative error of the energy
constexpr std::size_t kHeld = 2;     // nodes that stay on the centreline

/** Number of nodes with a shift: all but the one after the last. */
std::size_t shifted(const std::vector<BoreNode>& nodes)
{
  return nodes.size() - 1;
}

/** Change of direction at a node with the shifts: the length of its cell times u″. */
Eigen::Vector2d turn(const std::vector<BoreNode>& nodes, std::size_t i)
{
  return (nodes[i + 1].shift - nodes[i].shift) / nodes[i].edge -
         (nodes[i].shift - nodes[i - 1].shift) / nodes[i - 1].edge;
}

/** True where the next iteration would move the node by more than half the tolerance. On one side of the wall the
 *  problem is linear. Along the wall, a motion δ leaves the radial error δ²/(2c).
 *  @param from shift before the iteration [m] */
bool needsAnother(const BoreNode& node, const Eigen::Vector2d& from)
{
  if (node.wall <= 0.0)
    return false;
  const bool touches = node.shift.squaredNorm() > node.clearance * node.clearance;
  if (touches != (from.squaredNorm() > node.clearance * node.clearance))
    return true;
  return touches && (node.shift - from).squaredNorm() > kTolerance * std::max(kTolerance, node.clearance);
}

}  // namespace

Eigen::Vector2d BoreContact::bend(const std::vector<BoreNode>& nodes, std::size_t node)
{
  if (node == 0 || node + 2 >= nodes.size())
    return Eigen::Vector2d::Zero();
  return turn(nodes, node) / nodes[node].cell;
}

/** Adds bending, tension and the resistance to changes; the forces are those at zero shift. */
void BoreContact::addElasticity(const std::vector<BoreNode>& nodes)
{
  const std::size_t n = shifted(nodes);
  elastic_.assign(n, Row());
  force_.assign(nodes.size(), Eigen::Vector2d::Zero());
  for (std::size_t i = 1; i <= n; ++i)
  {
    const double before = 1.0 / nodes[i - 1].edge;
    const double after = i < n ? 1.0 / nodes[i].edge : 0.0;
    force_[i - 1] -= before * nodes[i].moment;
    force_[i] += (before + after) * nodes[i].moment;
    if (i < n)
      force_[i + 1] -= after * nodes[i].moment;
    if (i + 1 >= n)
      continue;
    const double stiffness = nodes[i].stiffness / nodes[i].cell;
    elastic_[i - 1].own += stiffness * before * before;
    elastic_[i - 1].next -= stiffness * before * (before + after);
    elastic_[i - 1].second += stiffness * before * after;
    elastic_[i].own += stiffness * (before + after) * (before + after);
    elastic_[i].next -= stiffness * after * (before + after);
    elastic_[i + 1].own += stiffness * after * after;
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    const double before = nodes[i > 0 ? i - 1 : 0].tension;
    force_[i] += (0.5 * (before + nodes[i].tension) * nodes[i].cell) * nodes[i].curvature;
    elastic_[i].own += kRestoring * nodes[i].cell;
    if (i + 1 >= n)
      continue;
    const double pull = std::max(0.0, nodes[i].tension) / nodes[i].edge;
    elastic_[i].own += pull;
    elastic_[i].next -= pull;
    elastic_[i + 1].own += pull;
  }
}

/** Assembles the matrix and the forces at the present shifts, without the nodes that are held. */
void BoreContact::assemble(const std::vector<BoreNode>& nodes)
{
  const std::size_t n = shifted(nodes);
  matrix_.reset(static_cast<int>(2 * (n - kHeld)));
  rhs_.assign(2 * (n - kHeld), 0.0);
  for (std::size_t i = kHeld; i < n; ++i)
  {
    const BoreNode& node = nodes[i];
    const Row& row = elastic_[i];
    const int r = static_cast<int>(2 * (i - kHeld));
    Eigen::Vector2d force = force_[i] - row.own * node.shift + (kRestoring * node.cell) * before_[i];
    if (i + 1 < n)
      force -= row.next * nodes[i + 1].shift;
    if (i + 2 < n)
      force -= row.second * nodes[i + 2].shift;
    force -= elastic_[i - 1].next * nodes[i - 1].shift + elastic_[i - 2].second * nodes[i - 2].shift;
    double across = 0.0;  // stiffness of the wall along its normal in excess of that across, and across
    double along = 0.0;
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    const double distance = node.shift.norm();
    if (distance > node.clearance && node.wall > 0.0)
    {
      const double wall = kWallStiffness * node.wall * node.cell;
      normal = node.shift / distance;
      across = wall * (1.0 - node.clearance / distance);
      along = wall - across;
      force -= (wall * (distance - node.clearance)) * normal;
    }
    matrix_.at(r, r) = row.own + across + along * normal.x() * normal.x();
    matrix_.at(r + 1, r) = along * normal.x() * normal.y();
    matrix_.at(r + 1, r + 1) = row.own + across + along * normal.y() * normal.y();
    for (int axis = 0; axis < 2; ++axis)
    {
      rhs_[r + axis] = force[axis];
      if (i + 1 < n)
        matrix_.at(r + 2 + axis, r + axis) = row.next;
      if (i + 2 < n)
        matrix_.at(r + 4 + axis, r + axis) = row.second;
    }
  }
}

double BoreContact::energy(const std::vector<BoreNode>& nodes) const
{
  const std::size_t n = shifted(nodes);
  double sum = 0.0;
  for (std::size_t i = kHeld; i < n; ++i)
  {
    const BoreNode& node = nodes[i];
    Eigen::Vector2d pull = 0.5 * elastic_[i].own * node.shift - (kRestoring * node.cell) * before_[i] - force_[i];
    if (i + 1 < n)
      pull += elastic_[i].next * nodes[i + 1].shift;
    if (i + 2 < n)
      pull += elastic_[i].second * nodes[i + 2].shift;
    const double depth = std::max(0.0, node.shift.norm() - node.clearance);
    sum += pull.dot(node.shift) + 0.5 * kWallStiffness * node.wall * node.cell * depth * depth;
  }
  return sum;
}

/** One iteration of Newton's method, shortened until the energy decreases.
 *  @return false when the shifts are within the tolerance */
bool BoreContact::improve(std::vector<BoreNode>& nodes)
{
  const std::size_t n = shifted(nodes);
  assemble(nodes);
  if (matrix_.factorise() != 0)
    return false;
  matrix_.solve(rhs_);
  trial_.resize(n);
  double largest = 0.0;
  for (std::size_t i = kHeld; i < n; ++i)
  {
    trial_[i] = nodes[i].shift;
    for (int axis = 0; axis < 2; ++axis)
      largest = std::max(largest, std::abs(rhs_[2 * (i - kHeld) + axis]));
  }
  double share = 1.0;
  for (int halving = 0;; ++halving, share *= 0.5)
  {
    for (std::size_t i = kHeld; i < n; ++i)
      nodes[i].shift = trial_[i] + share * Eigen::Vector2d(rhs_[2 * (i - kHeld)], rhs_[2 * (i - kHeld) + 1]);
    const double next = energy(nodes);
    if (next <= present_ + kRounding * std::abs(present_) || halving == kMaxHalvings)
    {
      present_ = next;
      break;
    }
  }
  if (share < 1.0)
    return largest > kTolerance;
  for (std::size_t i = kHeld; i < n; ++i)
    if (needsAnother(nodes[i], trial_[i]))
      return largest > kTolerance;
  return false;
}

void BoreContact::updateLoads(const std::vector<BoreNode>& nodes)
{
  load_.assign(nodes.size(), 0.0);
  for (std::size_t i = kHeld; i < shifted(nodes); ++i)
    load_[i] = kWallStiffness * nodes[i].wall * std::max(0.0, nodes[i].shift.norm() - nodes[i].clearance);
}

void BoreContact::solve(std::vector<BoreNode>& nodes)
{
  const std::size_t n = shifted(nodes);
  before_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    if (i < kHeld)
      nodes[i].shift.setZero();
    before_[i] = nodes[i].shift;
  }
  nodes.back().shift.setZero();
  addElasticity(nodes);
  present_ = energy(nodes);
  for (iterations_ = 1; improve(nodes) && iterations_ < kMaxIterations; ++iterations_)
  {
  }
  updateLoads(nodes);
}

}  // namespace endovascular_sim::rod
