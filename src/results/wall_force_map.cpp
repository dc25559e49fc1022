#include "results/wall_force_map.h"

#include <cmath>

namespace endovascular_sim::results
{
namespace
{

constexpr int kUnknown = -2;             // region of a triangle that was not queried yet
constexpr std::size_t kReserved = 4096;  // reserved triangles with contact, sufficient for some minutes

}  // namespace

WallForceMap::WallForceMap(double threshold, const vessel::Vessel& vessel)
  : threshold_(threshold),
    facets_(vessel.mesh),
    finder_(vessel.centreline),
    region_of_triangle_(vessel.mesh.triangles.size(), kUnknown),
    record_of_triangle_(vessel.mesh.triangles.size(), -1),
    regions_(vessel.centreline.branches.size() + 1)
{
  centres_.reserve(vessel.mesh.triangles.size());
  for (const Eigen::Vector3i& corners : vessel.mesh.triangles)
    centres_.emplace_back(
        (vessel.mesh.vertices[corners[0]] + vessel.mesh.vertices[corners[1]] + vessel.mesh.vertices[corners[2]]) / 3.0);
  names_.emplace_back();
  for (std::size_t b = 0; b < vessel.centreline.branches.size(); ++b)
  {
    names_.push_back(vessel.centreline.branches[b].name);
    regions_[b + 1].totals.region = static_cast<int>(b);
    regions_[b + 1].totals.name = names_.back();
  }
  touched_.reserve(kReserved);
  last_step_over_.reserve(kReserved);
}

bool WallForceMap::isOnMesh(int triangle) const
{
  return triangle >= 0 && triangle < static_cast<int>(centres_.size());
}

const std::string& WallForceMap::regionName(int region) const
{
  return names_[static_cast<std::size_t>(region) + 1];
}

int WallForceMap::regionOf(const simulation::WallContact& contact)
{
  return isOnMesh(contact.triangle) ? regionOf(contact.triangle) : finder_.nearest(contact.position);
}

int WallForceMap::regionOf(int triangle)
{
  int& region = region_of_triangle_[static_cast<std::size_t>(triangle)];
  if (region == kUnknown)
    region = finder_.nearest(centre(triangle));
  return region;
}

WallForce& WallForceMap::recordOf(int triangle, int region)
{
  int& record = record_of_triangle_[static_cast<std::size_t>(triangle)];
  if (record < 0)
  {
    record = static_cast<int>(touched_.size());
    touched_.emplace_back();
    touched_.back().triangle = triangle;
    touched_.back().region = region;
    last_step_over_.push_back(0);
  }
  return touched_[static_cast<std::size_t>(record)];
}

void WallForceMap::add(Account& account, const simulation::WallContact& contact, int region, double force, double dt)
{
  if (account.step != steps_)
  {
    account.step = steps_;
    account.sum = 0.0;
    account.is_over = false;
  }
  WallForceTotals& totals = account.totals;
  totals.integral += force * dt;
  account.sum += force;
  if (account.sum > totals.peak_sum)
  {
    totals.peak_sum = account.sum;
    totals.peak_sum_time = time_;
  }
  if (force > totals.peak)
  {
    totals.peak = force;
    totals.peak_position = contact.position;
    totals.peak_region = region;
    totals.peak_time = time_;
  }
  if (force > threshold_ && !account.is_over)
  {
    account.is_over = true;
    totals.time_over_threshold += dt;
  }
}

void WallForceMap::add(const std::vector<simulation::WallContact>& contacts, double time, double dt)
{
  ++steps_;
  time_ = time;
  for (const simulation::WallContact& contact : contacts)
  {
    const double force = contact.normal_force.norm();
    if (!(force > 0.0) || !std::isfinite(force))
      continue;
    const int region = regionOf(contact);
    add(whole_, contact, region, force, dt);
    add(accountOf(region), contact, region, force, dt);
    const contact::FacetForces::Shares shares = facets_.divide(contact.resting_force, contact.touched);
    for (std::size_t k = 0; k < shares.count; ++k)
      add(shares.share[k], dt);
    if (shares.count == 0)
      add({contact.triangle, force}, dt);
  }
}

/** Adds the force of one contact on a triangle. */
void WallForceMap::add(const contact::FacetForce& share, double dt)
{
  if (!isOnMesh(share.triangle) || !(share.force > 0.0))
    return;
  WallForce& record = recordOf(share.triangle, regionOf(share.triangle));
  record.integral += share.force * dt;
  if (share.force > record.peak)
  {
    record.peak = share.force;
    record.peak_time = time_;
  }
  std::uint64_t& last_over =
      last_step_over_[static_cast<std::size_t>(record_of_triangle_[static_cast<std::size_t>(share.triangle)])];
  if (share.force > threshold_ && last_over != steps_)
  {
    last_over = steps_;
    record.time_over_threshold += dt;
  }
}

WallForceSummary WallForceMap::summary() const
{
  WallForceSummary summary;
  summary.threshold = threshold_;
  summary.time = time_;
  summary.whole = whole_.totals;
  for (const Account& account : regions_)
    if (account.step > 0)
      summary.regions.push_back(account.totals);
  return summary;
}

}  // namespace endovascular_sim::results
