#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "simulation/contact_forces.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::results
{

/** "No region": the vessel has no centreline. */
constexpr int kNoRegion = -1;

/** What the whole wall, or one region of it, has borne: normal forces from the first step on. */
struct WallForceTotals
{
  int region = kNoRegion;                                   ///< branch of the centreline; kNoRegion also for the whole
  std::string name;                                         ///< of the branch; empty for the whole
  double peak = 0.0;                                        ///< largest force at any one contact [N]
  Eigen::Vector3d peak_position = Eigen::Vector3d::Zero();  ///< [m]
  int peak_region = kNoRegion;
  double peak_time = 0.0;            ///< end of the step [s]
  double peak_sum = 0.0;             ///< largest sum of one step [N]
  double peak_sum_time = 0.0;        ///< end of the step [s]
  double integral = 0.0;             ///< of the sum over time [N·s]
  double time_over_threshold = 0.0;  ///< in which some contact had more than the threshold [s]
};

/** What one triangle of the wall has borne. */
struct WallForce
{
  int triangle = 0;
  int region = kNoRegion;            ///< branch of the centreline that the triangle's centre belongs to
  double peak = 0.0;                 ///< largest force at one contact [N]
  double peak_time = 0.0;            ///< end of the step [s]
  double integral = 0.0;             ///< of the forces over time [N·s]
  double time_over_threshold = 0.0;  ///< [s]
};

/** Totals of everything up to now. */
struct WallForceSummary
{
  double threshold = 0.0;  ///< [N]
  double time = 0.0;       ///< until when it was counted [s]
  WallForceTotals whole;
  std::vector<WallForceTotals> regions;  ///< those that were touched, in the order of the centreline's branches
};

/** Remembers what the wall has borne: per triangle, per region and as a whole.
 *
 *  Forces are those of wallContacts(), one per node of the wire. Where the wire lies along the wall a finer sampling
 *  shares the same load among more contacts: peaks and the time over the threshold then belong to the sampling, sums
 *  and integrals do not. Allocates only when a triangle is touched for the first time. */
class WallForceMap
{
public:
  /** @param threshold force of one contact above which its time counts as time over threshold [N]
   *  @param vessel the mesh whose triangles the contacts name; without a centreline there are no regions */
  WallForceMap(double threshold, const vessel::Vessel& vessel);

  /** Adds one step; to be called for every step of the simulation.
   *  @param contacts of the step; those without a known triangle (−1) count in the totals only
   *  @param time end of the step [s]
   *  @param dt length of the step [s] */
  void add(const std::vector<simulation::WallContact>& contacts, double time, double dt);

  /** Branch of the centreline that the centre of a contact's triangle belongs to (found once per triangle), or the
   *  contact itself where the triangle is not known. */
  int regionOf(const simulation::WallContact& contact);

  const std::vector<WallForce>& touched() const { return touched_; }  ///< in the order of the first touch
  const Eigen::Vector3d& centre(int triangle) const { return centres_[static_cast<std::size_t>(triangle)]; }  ///< [m]
  const std::string& regionName(int region) const;  ///< empty for kNoRegion

  WallForceSummary summary() const;

private:
  /** Totals with what is known of the current step. */
  struct Account
  {
    WallForceTotals totals;
    std::uint64_t step = 0;  ///< the last one that it was touched in, counted from 1
    double sum = 0.0;        ///< of that step [N]
    bool is_over = false;    ///< the threshold, in that step
  };

  bool isOnMesh(const simulation::WallContact& contact) const;
  WallForce& recordOf(int triangle, int region);
  Account& accountOf(int region) { return regions_[static_cast<std::size_t>(region + 1)]; }
  void add(Account& account, const simulation::WallContact& contact, int region, double force, double dt);

  double threshold_;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<std::string> names_;  ///< of "no region" and the branches
  vessel::BranchFinder finder_;
  std::vector<int> region_of_triangle_;
  std::vector<int> record_of_triangle_;  ///< −1: not touched
  std::vector<WallForce> touched_;
  std::vector<std::uint64_t> last_step_over_;  ///< of each touched triangle
  Account whole_;
  std::vector<Account> regions_;  ///< "no region" and the branches
  std::uint64_t steps_ = 0;
  double time_ = 0.0;
};

}  // namespace endovascular_sim::results
