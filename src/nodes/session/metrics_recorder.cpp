#include "nodes/session/metrics_recorder.h"

#include <algorithm>

#include "nodes/conversions/procedure_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "results/session_run.h"
#include "results/treatment_report.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kOutside = 19e-3;  ///< distance in front of the introducer at which an instrument is outside [m]

Eigen::Vector3d toVector(const geometry_msgs::Point& point)
{
  return {point.x, point.y, point.z};
}

double magnitude(const geometry_msgs::Vector3& v)
{
  return Eigen::Vector3d(v.x, v.y, v.z).norm();
}

/** Point of the wire at an arc length behind its tip [m]; the first node beyond the wire. */
Eigen::Vector3d pointBehindTip(const RodStateVisual& rod, double length)
{
  for (std::size_t k = rod.nodes.size() - 1; k > 0; --k)
  {
    const Eigen::Vector3d end = toVector(rod.nodes[k]);
    const Eigen::Vector3d edge = toVector(rod.nodes[k - 1]) - end;
    if (length <= edge.norm())
      return end + length / std::max(edge.norm(), 1e-12) * edge;
    length -= edge.norm();
  }
  return toVector(rod.nodes.front());
}

}  // namespace

procedure::Observation observationFrom(const RodStateVisual& rod, const scene::Scene& scene,
                                       const procedure::BranchLocator& locator, const std::vector<double>& pressures)
{
  procedure::Observation observation;
  observation.time = rod.time;
  const double furthest = *std::max_element(rod.insertion.begin(), rod.insertion.end());
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
  {
    procedure::InstrumentView view;
    view.hand = {rod.insertion.at(k), rod.rotation.at(k), rod.hand_force.at(k), rod.hand_torque.at(k),
                 k < pressures.size() ? pressures[k] : 0.0};
    view.outside = view.hand.insertion < -kOutside;
    view.tip = pointBehindTip(rod, furthest - std::max(0.0, view.hand.insertion));
    if (view.hand.insertion > 0.0)
      view.branch_position = locator.at(view.tip);
    const auto& balloon = scene.instruments[k].instrument.balloon;
    const double middle = balloon ? view.hand.insertion - balloon->from_tip - 0.5 * balloon->length : 0.0;
    if (middle > 0.0)
      view.balloon = pointBehindTip(rod, furthest - middle);
    observation.instruments.push_back(view);
  }
  procedure::markCovered(observation);
  return observation;
}

void MetricsRecorder::add(const VesselMesh& mesh)
{
  if (metrics_)
    return;  // the initial vessel defines the branches
  vessel_.mesh = fromMessage(mesh);
  vessel_.source = mesh.source;
  wall_ = vessel_.mesh;
  begin();
}

void MetricsRecorder::add(const VesselCentreline& centreline)
{
  if (metrics_)
    return;
  vessel_.centreline = fromMessage(centreline);
  vessel_.lesions = lesionsFromMessage(centreline);
  begin();
}

void MetricsRecorder::begin()
{
  if (vessel_.mesh.triangles.empty() || vessel_.centreline.branches.empty())
    return;
  const scene::EntryPose entry = scene::resolveEntry(scene_.entry, vessel_, scene_.file);
  metrics_ = std::make_unique<results::SessionMetrics>(scene_, vessel_.centreline, entry.position);
}

void MetricsRecorder::add(const RodStateVisual& rod)
{
  if (!metrics_ || rod.nodes.empty() || rod.insertion.size() != scene_.instruments.size() || !metrics_->isDue(rod.time))
    return;
  results::Sample sample;
  sample.observation = observationFrom(rod, scene_, metrics_->locator(), pressures_);
  for (const auto& [position, force] : contacts_)
    sample.addContact(position, force);
  metrics_->add(std::move(sample));
}

void MetricsRecorder::add(const ContactForces& forces)
{
  contacts_.clear();
  for (const ContactForce& contact : forces.contacts)
    contacts_.emplace_back(toVector(contact.position), magnitude(contact.normal_force));
}

void MetricsRecorder::add(const ProcedureStep& step)
{
  if (steps_.size() + 1 == step.begun)
  {
    if (!steps_.empty() && steps_.back().outcome == procedure::Progress::kRunning)
    {
      steps_.back().outcome = procedure::Progress::kDone;
      steps_.back().end = step.begin;
    }
    steps_.push_back(fromMessage(step));
  }
  else if (steps_.size() == step.begun && !steps_.empty())
    steps_.back() = fromMessage(step);
  failure_ = step.failure;
}

void MetricsRecorder::add(const WallDisplacement& moved)
{
  if (wall_.vertices.empty())
    return;
  const intervention::WallDisplacement vertices = fromMessage(moved, wall_.vertices.size());
  for (std::size_t k = 0; k < vertices.indices.size(); ++k)
    wall_.vertices[vertices.indices[k]] = vertices.positions[k];
}

void MetricsRecorder::add(const TreatmentVisual& treatment)
{
  stents_.clear();
  for (const TreatmentBody& stent : treatment.stents)
    if (stent.opened)
      stents_.push_back(fromMessage(stent));
}

void MetricsRecorder::write(const std::string& folder, const results::WallForceSummary* forces)
{
  if (!metrics_)
    return;
  metrics_->setSteps(steps_, failure_);
  if (forces != nullptr)
    metrics_->setWallForces(*forces);
  metrics_->setLesions(results::lesionOutcomes(vessel_, wall_, stents_));
  results::writeMetrics(*metrics_, folder);
}

}  // namespace endovascular_sim::nodes
