#include "nodes/session/metrics_recorder.h"

#include <algorithm>

#include "common/error.h"
#include "nodes/conversions/procedure_conversions.h"
#include "nodes/conversions/sample_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "results/lesson_mark.h"
#include "results/metrics_files.h"
#include "results/treatment_report.h"
#include "scene/scene_vessel.h"
#include "simulation/balloon_treatments.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kMostLacking = 1000;  // steps of a procedure in one gap
constexpr std::size_t kMostSteps = 100000;    // between two samples; more are those of a session without samples

/** Record of a step of the procedure that began and ended in a gap of the recording, before a recorded one. */
procedure::StepRecord lackingStep(const ProcedureStep& next)
{
  procedure::StepRecord record;
  record.name = "not recorded";
  record.begin = record.end = next.begin;
  record.outcome = procedure::Progress::kDone;
  return record;
}

}  // namespace

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
  const scene::EntryPose entry = scene::resolveStart(scene_, vessel_);
  metrics_ = std::make_unique<results::SessionMetrics>(scene_, vessel_.centreline, entry.position);
  for (results::Sample& sample : early_samples_)
    metrics_->add(std::move(sample));
  early_samples_.clear();
  for (const flow::BeatMeans& beat : early_beats_)
    metrics_->addBeat(beat);
  early_beats_.clear();
}

void MetricsRecorder::add(const SessionSample& message)
{
  if (message.step >= steps_)
    return;
  results::Sample sample = fromMessage(message, scene_.instruments.size());
  sampled_steps_ = std::max(sampled_steps_, message.step + 1);
  since_sample_.erase(since_sample_.begin(), since_sample_.lower_bound(sampled_steps_));
  if (metrics_)
    metrics_->add(std::move(sample));
  else
    early_samples_.push_back(std::move(sample));
}

void MetricsRecorder::add(const HeartPhase& heart)
{
  if (!scene_.flow)
    return;
  flow::BeatMeans beat;
  beat.root = heart.mean_root_pressure;
  beat.readings = heart.mean_readings;
  beat.lesions = heart.mean_lesion_pressures;
  beat.hyperaemia = heart.mean_hyperaemia != 0;
  beat.step = heart.mean_step;
  if (metrics_)
    metrics_->addBeat(beat);
  else if (early_beats_.empty() || early_beats_.back().step != beat.step)
    early_beats_.push_back(beat);
}

void MetricsRecorder::add(const DriveApplied& drive)
{
  if (drive.step < sampled_steps_ || drive.step >= steps_ || since_sample_.size() >= kMostSteps)
    return;
  results::Peaks peaks;
  peaks.addHands(drive.hand_force, drive.hand_torque);
  since_sample_[drive.step] = std::move(peaks);
}

void MetricsRecorder::add(const ProcedureStep& step)
{
  if (step.step >= steps_)
    return;
  if (may_lack_steps_ && step.begun < procedure_steps_.size() + kMostLacking)
    while (procedure_steps_.size() + 1 < step.begun)
      procedure_steps_.push_back(lackingStep(step));
  if (procedure_steps_.size() + 1 == step.begun)
    procedure_steps_.push_back(fromMessage(step));
  else if (procedure_steps_.size() == step.begun && !procedure_steps_.empty())
    procedure_steps_.back() = fromMessage(step);
  failure_ = step.failure;
}

void MetricsRecorder::add(const WallDisplacement& moved)
{
  if (wall_.vertices.empty() || moved.step >= steps_)
    return;
  intervention::move(fromMessage(moved, wall_.vertices.size()), wall_.vertices);
  followRisk(moved);
}

/** Adds an event when the wall comes at risk. The displacement holds the step of its balloon load, so that the time is
 *  that of the offline simulation, whenever the message arrives. */
void MetricsRecorder::followRisk(const WallDisplacement& moved)
{
  if (moved.at_risk && !at_risk_)
    risks_.push_back({simulation::nameOf(simulation::TreatmentEvent::kAtRisk), firstBalloon(),
                      static_cast<double>(moved.step + 1) * scene_.solver.time_step});
  at_risk_ = moved.at_risk;
}

int MetricsRecorder::firstBalloon() const
{
  const auto hasBalloon = [](const scene::DrivenInstrument& driven) { return driven.instrument.balloon.has_value(); };
  const auto first = std::find_if(scene_.instruments.begin(), scene_.instruments.end(), hasBalloon);
  return first == scene_.instruments.end() ? 0 : static_cast<int>(first - scene_.instruments.begin());
}

void MetricsRecorder::add(const TreatmentVisual& treatment)
{
  if (treatment.step >= steps_)
    return;
  const std::size_t size = treatment.event.size();
  if (treatment.event_time.size() != size || treatment.event_instrument.size() != size)
    throw InputError(names::kTreatmentVisual, "event, event_time, event_instrument", "must have the same length");
  events_.clear();  // every message holds all events so far
  for (std::size_t k = 0; k < size; ++k)
  {
    if (treatment.event_instrument[k] >= scene_.instruments.size())
      throw InputError(names::kTreatmentVisual, "event_instrument", "must be an index of the scene's instruments");
    const Event event = {treatment.event[k], static_cast<int>(treatment.event_instrument[k]), treatment.event_time[k]};
    if (event.kind != simulation::nameOf(simulation::TreatmentEvent::kAtRisk))
      events_.push_back(event);
    else if (!risks_.empty() && event.time < risks_.front().time)
      risks_.front() = event;  // before the state from which the run continues
  }
  stents_.clear();
  for (const TreatmentBody& stent : treatment.stents)
    if (stent.opened)
      stents_.push_back(fromMessage(stent));
}

std::vector<results::SessionError> MetricsRecorder::errors() const
{
  std::vector<results::SessionError> errors;
  if (metrics_)
    errors = metrics_->errors();
  for (const std::vector<Event>* events : {&events_, &risks_})
    for (const Event& event : *events)
      if (results::isError(event.kind))
        errors.push_back({event.kind, event.instrument, event.time, 0.0, ""});
  std::stable_sort(errors.begin(), errors.end(),
                   [](const results::SessionError& a, const results::SessionError& b) { return a.time < b.time; });
  return errors;
}

std::vector<std::pair<double, std::string>> MetricsRecorder::wrongBranches() const
{
  std::vector<std::pair<double, std::string>> entries;
  if (!metrics_)
    return entries;
  metrics_->setSteps(procedure_steps_, failure_);
  for (const results::WrongBranch& stay : metrics_->wrongBranches())
    entries.emplace_back(stay.begin, scene_.instruments[static_cast<std::size_t>(stay.instrument)].instrument.name +
                                         " in " + metrics_->locator().name(stay.branch));
  return entries;
}

std::vector<results::Mark> MetricsRecorder::marks() const
{
  return metrics_ ? results::lessonMarks(*metrics_) : std::vector<results::Mark>();
}

std::string MetricsRecorder::verdict() const
{
  return metrics_ ? results::verdict(results::lessonMarks(*metrics_), results::stepsBefore(*metrics_)) : std::string();
}

void MetricsRecorder::write(const std::string& folder, const results::WallForceSummary* forces,
                            const results::RecordingNotes& notes)
{
  if (!metrics_)
    return;
  metrics_->setNotes(notes);
  metrics_->setSteps(procedure_steps_, failure_);
  for (const auto& [step, peaks] : since_sample_)
    metrics_->addTail(peaks);
  for (const std::vector<Event>* events : {&events_, &risks_})
    for (const Event& event : *events)
      metrics_->addEvent(event.kind, event.instrument, event.time);
  if (forces != nullptr)
    metrics_->setWallForces(*forces);
  metrics_->setLesions(results::lesionOutcomes(vessel_, wall_, stents_));
  results::writeMetrics(*metrics_, folder);
}

}  // namespace endovascular_sim::nodes
