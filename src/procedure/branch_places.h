#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/polyline.h"
#include "scene/model/scene_procedure.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::procedure
{

/** Where something is in the tree of branches. */
struct BranchPlace
{
  int branch = -1;     ///< of the centreline; −1: not in the vessel
  double depth = 0.0;  ///< along it from its ostium, distal is positive [m]
};

/** Tells places by branches, as a person reads them from the picture, and which branches lead from one to another. */
class BranchPlaces
{
public:
  /** @param tree of the vessel
   *  @param names that the procedure gives to branches, besides their own */
  explicit BranchPlaces(const vessel::CentrelineTree& tree, const std::vector<scene::NamedBranch>& names = {});

  /** @param point patient frame [m] */
  BranchPlace at(const Eigen::Vector3d& point) const;

  /** Distance of a place from the ostium of a branch, along that branch [m]; beyond its ends it stays the end's. */
  double depthIn(int branch, const Eigen::Vector3d& point) const;

  /** Branch of a name, −1 when there is none; a name of the procedure's goes before a name of the vessel's. */
  int find(const std::string& name) const;

  /** Name of a branch, the procedure's where it gives one; "outside" for −1. */
  const std::string& name(int branch) const;

  /** All names, for messages. */
  std::string names() const;

  /** Whether every branch lies on the way from one branch to another, both included. Without a goal (−1) all do. */
  std::vector<bool> wayBetween(int from, int to) const;

  const geometry::Polyline& line(int branch) const { return lines_[static_cast<std::size_t>(branch)]; }

  int branches() const { return static_cast<int>(names_.size()); }

private:
  std::vector<geometry::Polyline> lines_;
  std::vector<double> ostium_;  ///< arc length at which a branch leaves the wider ones it comes from [m]
  std::vector<int> parent_;
  std::vector<std::string> names_;      ///< shown
  std::vector<std::string> own_names_;  ///< of the vessel
  vessel::BranchFinder finder_;
};

}  // namespace endovascular_sim::procedure
