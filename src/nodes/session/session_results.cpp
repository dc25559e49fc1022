#include "nodes/session/session_results.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <ros/time.h>

#include "common/output_file.h"
#include "common/version.h"
#include "contact/contract/contact_set.h"
#include "nodes/conversions/contact_force_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "results/wall_force_report.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Name of the node in the name of a diagnostic status: "rod_dynamics" in "/rod_dynamics: simulation". */
std::string nodeOf(const std::string& status_name)
{
  const std::string node = status_name.substr(0, status_name.find(':'));
  return !node.empty() && node.front() == '/' ? node.substr(1) : node;
}

/** Calls a function and logs its error. @return true without an error */
template <typename Work>
bool tryTo(const Work& work)
{
  try
  {
    work();
    return true;
  }
  catch (const InputError& error)
  {
    ROS_ERROR("%s", error.what());
    return false;
  }
}

}  // namespace

results::SessionIdentity identityOf(const scene::Scene& scene)
{
  results::SessionIdentity identity;
  identity.scene_name = scene.name;
  identity.scene_file = scene.file;
  identity.scene_hash = scene.hash();
  identity.seed = scene.seed;
  identity.time_step = scene.solver.time_step;
  identity.duration = scene.duration;
  identity.software_version = version();
  identity.commit = commit();
  identity.physics = kPhysicsNumber;
  return identity;
}

SessionResults::SessionResults(const scene::Scene& scene, std::string folder, std::uint64_t steps)
  : SessionResults(scene, identityOf(scene), std::move(folder), steps)
{
}

SessionResults::SessionResults(const scene::Scene& scene, results::SessionIdentity identity, std::string folder,
                               std::uint64_t steps)
  : folder_(std::move(folder)),
    steps_(steps),
    has_vessel_(scene.vessel.has_value()),
    report_(std::move(identity)),
    trajectory_(path("trajectory.csv"), scene.record.trajectory_rate),
    metrics_(scene, steps)
{
  writeTextFile(path("scene.yaml"), scene.resolved_yaml);
}

void SessionResults::add(const DriveApplied& drive)
{
  // Simulated time says nothing about the elapsed one.
  const double now = ros::Time::isSimTime() ? ros::WallTime::now().toSec() : drive.header.stamp.toSec();
  report_.addStep(drive.step, now, drive.first_stale_pass != contact::kNoStalePass, drive.state_hash);
  if (drive.first_stale_pass != contact::kNoStalePass)
    return;  // the forces of a step with a fault are left out, as in the metrics
  report_.addHands(drive.hand_force, drive.hand_torque);
  metrics_.add(drive);
}

void SessionResults::add(const RodStateVisual& rod)
{
  if (rod.nodes.empty() || rod.insertion.empty())
    return;
  const geometry_msgs::Point& tip = rod.nodes.back();
  results::TrajectoryRow row;
  row.time = rod.time;
  const auto furthest =
      static_cast<std::size_t>(std::max_element(rod.insertion.begin(), rod.insertion.end()) - rod.insertion.begin());
  row.insertion = rod.insertion.at(furthest);
  row.rotation = rod.rotation.at(furthest);
  row.tip_rotation = rod.tip_rotation.at(furthest);
  row.hand_force = rod.hand_force.at(furthest);
  row.hand_torque = rod.hand_torque.at(furthest);
  row.tip = {tip.x, tip.y, tip.z};
  row.nodes = rod.nodes.size();
  for (double pressure : rod.pressure)
    row.pressure = std::max(row.pressure, pressure);
  report_.addTip(row.tip, row.insertion, row.nodes);
  const bool was_complete = trajectory_.error().empty();
  if (!trajectory_.add(row) && was_complete)
    ROS_ERROR("%s", trajectory_.error().c_str());
}

void SessionResults::add(const ContactForceMapConstPtr& map)
{
  if (map->step >= steps_)
    return;
  force_map_ = map;
  report_.setWallForces(summaryFromMessage(*force_map_), force_map_->triangles.size());
}

void SessionResults::add(const VesselMeshConstPtr& vessel)
{
  vessel_ = vessel;
  tryTo([this] { metrics_.add(*vessel_); });
  report_.setMeshHash(vessel_->content_hash);
  for (const geometry_msgs::Point& vertex : vessel_->mesh.vertices)
    report_.addVesselPoint({vertex.x, vertex.y, vertex.z});
}

void SessionResults::add(const VesselCentreline& centreline)
{
  tryTo([this, &centreline] { metrics_.add(centreline); });
}

void SessionResults::add(const diagnostic_msgs::DiagnosticArray& diagnostics)
{
  for (const diagnostic_msgs::DiagnosticStatus& status : diagnostics.status)
    for (const diagnostic_msgs::KeyValue& value : status.values)
      report_.addDiagnostic(nodeOf(status.name), value.key, value.value);
}

void SessionResults::add(const SessionMark& mark)
{
  report_.add(results::Remark{mark.step, mark.time, mark.text});
}

/** Adds a gap once: both bags beside it hold it. */
void SessionResults::add(const SessionGap& gap)
{
  const std::vector<results::RecordingGap>& known = report_.notes().gaps;
  if (std::any_of(known.begin(), known.end(),
                  [&](const results::RecordingGap& other) { return other.first_step == gap.first_step; }))
    return;
  report_.add(results::RecordingGap{gap.first_step, gap.last_step, gap.previous, gap.next});
  metrics_.allowMissingSteps();
}

bool SessionResults::hasFinalMap() const
{
  return !has_vessel_ || (force_map_ && force_map_->step + 1 >= steps_);
}

void SessionResults::writeWallForces() const
{
  if (!force_map_ || !vessel_ || force_map_->content_hash != vessel_->content_hash)
    return;
  const geometry::TriangleMesh mesh = fromMessage(*vessel_);
  std::vector<std::string> names(static_cast<std::size_t>(std::numeric_limits<std::uint16_t>::max()) + 1);
  for (const ContactForceTotals& region : force_map_->regions)
    names[region.region] = region.name;
  std::vector<results::WallForceRow> rows;
  for (const results::WallForce& force : touchedFromMessage(*force_map_))
  {
    if (force.triangle < 0 || force.triangle >= static_cast<int>(mesh.triangles.size()))
      continue;
    const Eigen::Vector3i& corners = mesh.triangles[static_cast<std::size_t>(force.triangle)];
    const Eigen::Vector3d centre =
        (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3.0;
    rows.push_back({force, centre, names[regionToMessage(force.region)]});
  }
  writeTextFile(path("wall_forces.csv"), results::wallForcesCsv(std::move(rows)));
  writeTextFile(path("vessel_points.csv"), results::vesselPointsCsv(mesh.vertices));
}

bool SessionResults::write(const results::RecordingOutcome& recording, const std::string& error)
{
  const bool was_complete = trajectory_.error().empty();
  const bool rows_written = trajectory_.flush();
  if (was_complete && !rows_written)
    ROS_ERROR("%s", trajectory_.error().c_str());
  results::WallForceSummary forces;
  if (force_map_)
    forces = summaryFromMessage(*force_map_);
  const bool report = tryTo([&] { writeTextFile(path("report.json"), report_.json(recording, error)); });
  const bool metrics = tryTo([&] { metrics_.write(folder_, force_map_ ? &forces : nullptr, report_.notes()); });
  const bool map = tryTo([&] { writeWallForces(); });
  return rows_written && report && metrics && map;
}

}  // namespace endovascular_sim::nodes
