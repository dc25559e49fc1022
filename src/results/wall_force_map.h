#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "contact/wall/facet_forces.h"
#include "simulation/contact_forces.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::results
{

/** Region of a contact in a vessel without a centreline. */
constexpr int kNoRegion = -1;

/** Accumulated normal forces on the whole wall or on one region. */
struct WallForceTotals
{
  int region = kNoRegion;                                   ///< branch of the centreline; kNoRegion for the whole wall
  std::string name;                                         ///< name of the branch; empty for the whole wall
  double peak = 0.0;                                        ///< largest force of a single contact [N]
  Eigen::Vector3d peak_position = Eigen::Vector3d::Zero();  ///< position of the peak [m]
  int peak_region = kNoRegion;                              ///< region of the peak
  double peak_time = 0.0;                                   ///< end of the step with the peak [s]
  double peak_sum = 0.0;                                    ///< largest sum of the forces of one step [N]
  double peak_sum_time = 0.0;                               ///< end of the step with the largest sum [s]
  double integral = 0.0;                                    ///< time integral of the sum of the forces [N·s]
  double time_over_threshold = 0.0;                         ///< time with at least one contact above the threshold [s]
};

/** Accumulated normal forces on one triangle of the wall. */
struct WallForce
{
  int triangle = 0;                  ///< index of the triangle
  int region = kNoRegion;            ///< branch of the centreline nearest to the centre of the triangle
  double peak = 0.0;                 ///< largest force of a single contact on it [N]
  double peak_time = 0.0;            ///< end of the step with the peak [s]
  double integral = 0.0;             ///< time integral of the forces along its normal [N·s]
  double time_over_threshold = 0.0;  ///< time with at least one contact above the threshold [s]
};

/** Totals of the wall forces up to a time. */
struct WallForceSummary
{
  double threshold = 0.0;  ///< threshold of time_over_threshold [N]
  double time = 0.0;       ///< end of the last step [s]
  WallForceTotals whole;
  std::vector<WallForceTotals> regions;  ///< regions with contact, in the order of the centreline's branches
};

/** Accumulator of the forces on the wall: per triangle, per region and in total.
 *
 *  The forces are those of wallContacts(), one per node of the wire. A node that touches several facets counts as one
 *  contact in the totals; every triangle receives the share of its own facet, along its normal. Along a line contact, a
 * finer sampling divides the same load among more contacts. Peaks and times over the threshold therefore depend on the
 * sampling, but sums and integrals do not. Memory is allocated only at the first contact of a triangle. */
class WallForceMap
{
public:
  /** @param threshold force of a single contact above which its time counts as time over threshold [N]
   *  @param vessel vessel with the mesh of the contacts; without a centreline there are no regions */
  WallForceMap(double threshold, const vessel::Vessel& vessel);

  /** Adds one step; to be called after each step of the simulation.
   *  @param contacts contacts of the step; those without a triangle (−1) count in the totals only
   *  @param time end of the step [s]
   *  @param dt duration of the step [s] */
  void add(const std::vector<simulation::WallContact>& contacts, double time, double dt);

  /** Branch of the centreline nearest to the centre of a contact's triangle, cached per triangle; without a triangle,
   *  the branch nearest to the contact. */
  int regionOf(const simulation::WallContact& contact);

  /** Triangles with contact, in the order of their first contact. */
  const std::vector<WallForce>& touched() const { return touched_; }
  /** Centre of a triangle [m]. */
  const Eigen::Vector3d& centre(int triangle) const { return centres_[static_cast<std::size_t>(triangle)]; }
  /** Name of a region; empty for kNoRegion. */
  const std::string& regionName(int region) const;

  WallForceSummary summary() const;

private:
  /** Totals with the intermediate values of the current step. */
  struct Account
  {
    WallForceTotals totals;
    std::uint64_t step = 0;  ///< last step with contact, counted from 1
    double sum = 0.0;        ///< sum of the forces of that step [N]
    bool is_over = false;    ///< true if a contact of that step exceeds the threshold
  };

  bool isOnMesh(int triangle) const;
  int regionOf(int triangle);
  void add(const contact::FacetForce& share, double dt);
  WallForce& recordOf(int triangle, int region);
  Account& accountOf(int region) { return regions_[static_cast<std::size_t>(region) + 1]; }
  void add(Account& account, const simulation::WallContact& contact, int region, double force, double dt);

  double threshold_;
  contact::FacetForces facets_;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<std::string> names_;  ///< names of "no region" and the branches
  vessel::BranchFinder finder_;
  std::vector<int> region_of_triangle_;
  std::vector<int> record_of_triangle_;  ///< index in touched_; −1: no contact yet
  std::vector<WallForce> touched_;
  std::vector<std::uint64_t> last_step_over_;  ///< for each entry of touched_: last step above the threshold
  Account whole_;
  std::vector<Account> regions_;  ///< accounts of "no region" and the branches
  std::uint64_t steps_ = 0;
  double time_ = 0.0;
};

}  // namespace endovascular_sim::results
