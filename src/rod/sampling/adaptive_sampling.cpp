#include "rod/sampling/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "rod/model/node_curvature.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kWindow = 3.0;       // range of a curvature along the wire, in shortest edges
constexpr double kTipEdges = 3.0;     // length of the tip that looks ahead, and its distance, in longest edges
constexpr int kQueriesAhead = 4;      // intervals between the points queried ahead
constexpr double kFineTip = 3.0;      // length of the fine tip, whose end touches the wall, in shortest edges
constexpr int kGuideLevels = 1;       // bisections of the shortest edge at the outer end of the guide
constexpr double kFineGuide = 1.0;    // length of that part inside the guide, in shortest edges
constexpr double kMergeGuide = 1.0;   // further length before edges may merge (hysteresis), in shortest edges
constexpr double kFineOutside = 4.0;  // length of that part outside the guide, in longest edges

SamplingSettings withGuideLevels(SamplingSettings settings, const Boundary& boundary)
{
  settings.extra_levels = boundary.introducer ? kGuideLevels : 0;
  return settings;
}

}  // namespace

AdaptiveSampling::AdaptiveSampling(const Wire& wire, const Boundary& boundary, const SamplingSettings& settings,
                                   CurvatureAhead ahead)
  : wire_(wire),
    boundary_(boundary),
    settings_(settings),
    ahead_(std::move(ahead)),
    tree_(wire.length(), withGuideLevels(settings, boundary))
{
  tree_.positions(position_);
  discretise(wire_, position_, rod_);
  next_rod_ = rod_;
  curvature_.reserve(position_.size());
  demand_.reserve(position_.size());
}

bool AdaptiveSampling::update(State& state, const std::vector<Eigen::Vector3d>* at_rest)
{
  measureCurvature(state, at_rest != nullptr ? *at_rest : state.position);
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

void AdaptiveSampling::measureCurvature(const State& state, const std::vector<Eigen::Vector3d>& at_rest)
{
  const int n = rod_.nodes();
  curvature_.assign(static_cast<std::size_t>(n), 0.0);
  for (int i = state.first_node + 1; i + 1 < n; ++i)
    curvature_[i] = binormalAt(rod_, state, i).value.norm() / rod_.cell_length[i];
  if (!ahead_)
    return;
  const double beyond = curvatureBeyondTip(at_rest[n - 2], at_rest[n - 1]);
  for (int i = n - 1; i >= 0 && rod_.length() - rod_.position[i] < kTipEdges * settings_.max_edge; --i)
    curvature_[i] = std::max(curvature_[i], beyond);
}

double AdaptiveSampling::curvatureBeyondTip(const Eigen::Vector3d& before_tip, const Eigen::Vector3d& tip)
{
  if (beyond_tip_ >= 0.0 && (tip - queried_from_).norm() < settings_.min_edge)
    return beyond_tip_;
  const Eigen::Vector3d along = (tip - before_tip).normalized();
  queried_from_ = tip;
  beyond_tip_ = 0.0;
  for (int k = 0; k <= kQueriesAhead; ++k)
  {
    const double distance = kTipEdges * settings_.max_edge * k / kQueriesAhead;
    beyond_tip_ = std::max(beyond_tip_, ahead_(tip + distance * along));
  }
  return beyond_tip_;
}

/** Demands the largest curvature within the window around each edge. */
void AdaptiveSampling::demandOfShape(const State& state)
{
  const int n = rod_.nodes();
  const double window = kWindow * settings_.min_edge;
  demand_.assign(static_cast<std::size_t>(n) - 1, {0.0, tree_.coarsestLevel(), settings_.min_age});
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

/** Demands fine section joints, and in curved sections edges no coarser than their rest curvature requires. */
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
    while (coarsest > tree_.fineLevel() && rest * tree_.edge(coarsest) > settings_.turn_per_edge)
      --coarsest;
    const double touching = 1e-6 * tree_.edge(0);
    while (leaf > 0 && rod_.position[leaf] > begin - touching)
      --leaf;
    for (; leaf < leaves && rod_.position[leaf] < end + touching; ++leaf)
    {
      const bool at_begin = begin > 0.0 && rod_.position[leaf] < begin + touching;
      const bool at_end = end < rod_.length() - touching && rod_.position[leaf + 1] > end - touching;
      const bool joint = (at_begin && rod_.position[leaf + 1] > begin - touching) || at_end;
      demand_[leaf].coarsest = std::min(demand_[leaf].coarsest, joint ? tree_.fineLevel() : coarsest);
    }
    begin = end;
  }
}

/** Demands a fixed sampling at the ends of the wire. */
void AdaptiveSampling::restrictDemand(const State& state)
{
  const int leaves = rod_.nodes() - 1;
  const auto limit = [this](int leaf, int level) { demand_[leaf].coarsest = std::min(demand_[leaf].coarsest, level); };
  for (int j = leaves - 1; j >= 0 && rod_.length() - rod_.position[j + 1] < kFineTip * settings_.min_edge; --j)
    limit(j, tree_.fineLevel());
  if (!boundary_.introducer)
  {
    if (boundary_.proximal == EndHold::kClamped)
      limit(0, tree_.fineLevel());
    return;
  }
  const double outer_end = rod_.length() - state.inserted_length - boundary_.guide_length;
  const double fine_begin = outer_end - kFineOutside * settings_.max_edge;
  const double fine_end = outer_end + kFineGuide * settings_.min_edge;
  const double guide_end = outer_end + boundary_.guide_length;
  for (int j = 0; j < leaves && rod_.position[j] < guide_end; ++j)
  {
    demand_[j].min_age = 0;
    if (rod_.position[j + 1] <= fine_begin || rod_.position[j] >= fine_end + kMergeGuide * settings_.min_edge)
      continue;
    demand_[j].min_age = kNeverMerged;
    if (rod_.position[j] < fine_end)
      limit(j, 0);
  }
}

void AdaptiveSampling::archive(Archive& archive)
{
  archive(tree_, beyond_tip_, queried_from_);
  if (!archive.reading())
    return;
  requireFinite(beyond_tip_, queried_from_);
  tree_.positions(position_);
  discretise(wire_, position_, rod_);
}

}  // namespace endovascular_sim::rod
