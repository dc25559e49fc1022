#include "rod/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

#include "rod/bending.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kWindow = 3.0;      // of the shortest edge: how far a curvature reaches along the wire
constexpr double kTipEdges = 3.0;    // of the longest edge: the part of the wire that looks ahead, and how far it does
constexpr int kLooksAhead = 4;       // places at which it looks
constexpr double kFineGuide = 2.0;   // longest edges of the guide, from its outer end, that stay fine
constexpr double kMergeGuide = 2.0;  // further in by so many, edges may merge

}  // namespace

AdaptiveSampling::AdaptiveSampling(const Wire& wire, const Boundary& boundary, const SamplingSettings& settings,
                                   CurvatureAhead ahead)
  : wire_(wire),
    boundary_(boundary),
    settings_(settings),
    ahead_(std::move(ahead)),
    tree_(wire.length(), settings)
{
  tree_.positions(position_);
  discretise(wire_, position_, rod_);
  next_rod_ = rod_;
  curvature_.reserve(position_.size());
  demand_.reserve(position_.size());
}

bool AdaptiveSampling::update(State& state)
{
  measureCurvature(state);
  demandOfShape(state);
  setFixedDemand();
  restrictDemand(state);
  if (!tree_.update(demand_))
    return false;
  tree_.positions(position_);
  discretise(wire_, position_, next_rod_);
  resampling_.carry(wire_, rod_, next_rod_, state);
  std::swap(rod_, next_rod_);
  return true;
}

void AdaptiveSampling::measureCurvature(const State& state)
{
  const int n = rod_.nodes();
  curvature_.assign(static_cast<std::size_t>(n), 0.0);
  for (int i = state.first_node + 1; i + 1 < n; ++i)
    curvature_[i] =
        CurvatureBinormal(state.position[i] - state.position[i - 1], state.position[i + 1] - state.position[i],
                          rod_.rest_length[i - 1] * rod_.rest_length[i])
            .value.norm() /
        rod_.cell_length[i];
  if (!ahead_)
    return;
  const double beyond = curvatureBeyondTip(state);
  for (int i = n - 1; i >= 0 && rod_.length() - rod_.position[i] < kTipEdges * settings_.max_edge; --i)
    curvature_[i] = std::max(curvature_[i], beyond);
}

double AdaptiveSampling::curvatureBeyondTip(const State& state) const
{
  const std::size_t tip = state.position.size() - 1;
  const Eigen::Vector3d along = (state.position[tip] - state.position[tip - 1]).normalized();
  double largest = 0.0;
  for (int k = 0; k <= kLooksAhead; ++k)
  {
    const double distance = kTipEdges * settings_.max_edge * k / kLooksAhead;
    largest = std::max(largest, ahead_(state.position[tip] + distance * along));
  }
  return largest;
}

/** Largest curvature within the window round each edge. */
void AdaptiveSampling::demandOfShape(const State& state)
{
  const int n = rod_.nodes();
  const double window = kWindow * settings_.min_edge;
  demand_.assign(static_cast<std::size_t>(n) - 1, {0.0, tree_.coarsestLevel(), true});
  int first = state.first_node;
  for (int j = state.first_node; j + 1 < n; ++j)
  {
    while (rod_.position[first] < rod_.position[j] - window)
      ++first;
    double largest = 0.0;
    for (int i = first; i < n && rod_.position[i] <= rod_.position[j + 1] + window; ++i)
      largest = std::max(largest, curvature_[i]);
    demand_[j].curvature = largest;
  }
}

/** Section joints stay fine, and a curved section is never coarser than its rest curvature asks for. */
void AdaptiveSampling::setFixedDemand()
{
  double begin = 0.0;
  int leaf = 0;
  const int leaves = rod_.nodes() - 1;
  for (const Section& section : wire_.sections)
  {
    const double end = begin + section.length;
    const double rest = section.rest_curvature.norm();
    int coarsest = tree_.coarsestLevel();
    while (coarsest > 0 && rest * tree_.edge(coarsest) > settings_.turn_per_edge)
      --coarsest;
    const double touching = 1e-6 * tree_.edge(0);
    while (leaf > 0 && rod_.position[leaf] > begin - touching)
      --leaf;
    for (; leaf < leaves && rod_.position[leaf] < end + touching; ++leaf)
    {
      const bool at_begin = begin > 0.0 && rod_.position[leaf] < begin + touching;
      const bool at_end = end < rod_.length() - touching && rod_.position[leaf + 1] > end - touching;
      const bool joint = (at_begin && rod_.position[leaf + 1] > begin - touching) || at_end;
      demand_[leaf].coarsest = std::min(demand_[leaf].coarsest, joint ? 0 : coarsest);
    }
    begin = end;
  }
}

/** Where the boundary wants the sampling to be the same at all times. */
void AdaptiveSampling::restrictDemand(const State& state)
{
  const int leaves = rod_.nodes() - 1;
  if (!boundary_.introducer)
  {
    if (boundary_.proximal == EndHold::kClamped)
      demand_[0].coarsest = 0;
    if (boundary_.distal == EndHold::kClamped)
      demand_[leaves - 1].coarsest = 0;
    return;
  }
  const double outer_end = rod_.length() - state.inserted_length - boundary_.guide_length;
  const double fine = outer_end + kFineGuide * settings_.max_edge;
  const double free = fine + kMergeGuide * settings_.max_edge;
  for (int j = 0; j < leaves && rod_.position[j] < free; ++j)
  {
    demand_[j].mergeable = false;
    if (rod_.position[j] < fine)
      demand_[j].coarsest = 0;
  }
}

}  // namespace endovascular_sim::rod
