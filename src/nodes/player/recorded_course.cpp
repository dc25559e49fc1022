#include "nodes/player/recorded_course.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/error.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/error_text.h"
#include "nodes/session/metrics_recorder.h"
#include "nodes/session/session_bag.h"
#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr auto kWrongBranch = "wrong branch";
constexpr double kSamplesApart = 0.25;  ///< longest time between an entry and the sample that shows it [s]

/** Calls a function for the readable messages of some topics, in the order of their times. */
template <typename Visit>
void forEach(const BagTimeline& timeline, const std::vector<std::string>& names, const Visit& visit)
{
  for (const std::uint32_t entry : timeline.entriesOf(names))
  {
    try
    {
      visit(timeline.message(entry));
    }
    catch (const ros::Exception&)
    {
      continue;  // the bytes of the message are damaged; the timeline names them
    }
  }
}

void followLargest(const std::vector<double>& forces, std::vector<double>& largest)
{
  largest.resize(std::max(largest.size(), forces.size()), 0.0);
  for (std::size_t k = 0; k < forces.size(); ++k)
    if (std::abs(forces[k]) > largest[k])
      largest[k] = std::abs(forces[k]);
}

double largestNodeForce(const RodStateVisual& rod)
{
  double largest = 0.0;
  for (const geometry_msgs::Vector3& force : rod.contact_force)
    largest = std::max(largest, std::hypot(force.x, force.y, force.z));
  return largest;
}

void addToMetrics(const BagMessage& message, MetricsRecorder& metrics)
{
  if (isTopic(message.topic, names::kVesselMesh))
    metrics.add(*message.read<VesselMesh>());
  else if (isTopic(message.topic, names::kVesselCentreline))
    metrics.add(*message.read<VesselCentreline>());
  else if (isTopic(message.topic, names::kSessionSample))
    metrics.add(*message.read<SessionSample>());
  else if (isTopic(message.topic, names::kTreatmentVisual))
    metrics.add(*message.read<TreatmentVisual>());
  else if (isTopic(message.topic, names::kProcedureStep))
    metrics.add(*message.read<ProcedureStep>());
  else
    metrics.add(*message.read<WallDisplacement>());
}

}  // namespace

RecordedCourse::RecordedCourse(const BagTimeline& timeline)
{
  addSteps(timeline);
  addMetricErrors(timeline);
  addMarks(timeline);
  std::stable_sort(chapters_.begin(), chapters_.end(),
                   [](const PlayerChapter& a, const PlayerChapter& b) { return a.time < b.time; });
  addViews(timeline);
  followForces(timeline);
}

std::string RecordedCourse::viewAt(ros::Time time) const
{
  const auto later = views_.upper_bound(time);
  return later == views_.begin() ? std::string() : std::prev(later)->second;
}

void RecordedCourse::add(std::uint8_t kind, double time, const std::string& name)
{
  PlayerChapter chapter;
  chapter.kind = kind;
  chapter.time = time;
  chapter.name = name;
  if (std::isfinite(time))
    chapters_.push_back(chapter);
}

/** Adds the steps of the procedure, and the errors that its messages report. */
void RecordedCourse::addSteps(const BagTimeline& timeline)
{
  ProcedureStep before;
  forEach(timeline, {names::kProcedureStep},
          [&](const BagMessage& message)
          {
            const ProcedureStep step = *message.read<ProcedureStep>();
            const bool is_new = step.begun != before.begun;
            if (is_new)
              add(PlayerChapter::STEP, step.begin, step.phase + (step.phase.empty() ? "" : ", ") + step.name);
            // As the panel, which does not announce what a loaded state publishes again.
            if (!(is_new && step.outcome == ProcedureStep::DONE) &&
                step.wrong_branches > (is_new ? 0U : before.wrong_branches))
              add(PlayerChapter::ERROR, step.time, kWrongBranch);
            if ((is_new || step.outcome != before.outcome) && step.outcome == ProcedureStep::LOST)
              add(PlayerChapter::ERROR, step.time, "support lost: an earlier step is repeated");
            if ((is_new || step.outcome != before.outcome) && step.outcome == ProcedureStep::FAILED)
              add(PlayerChapter::ERROR, step.time, "step failed: " + step.failure);
            before = step;
          });
}

/** Adds the errors of the metrics, from the messages from which the session found them. */
void RecordedCourse::addMetricErrors(const BagTimeline& timeline)
{
  if (!timeline.info())
    return;
  try
  {
    const scene::Scene scene = scene::parseRecordedScene(timeline.info()->scene_yaml, timeline.files().front());
    MetricsRecorder metrics(scene);
    std::string refused;
    forEach(timeline,
            {names::kVesselMesh, names::kVesselCentreline, names::kSessionSample, names::kTreatmentVisual,
             names::kWallDisplacement, names::kProcedureStep},
            [&](const BagMessage& message)
            {
              try
              {
                addToMetrics(message, metrics);
              }
              catch (const InputError& error)
              {
                refused = error.what();
              }
            });
    if (!refused.empty())
      missing_.push_back("errors of the metrics may be missing: " + refused);
    for (const results::SessionError& error : metrics.errors())
      add(PlayerChapter::ERROR, error.time, textOf(error, scene));
    nameWrongBranches(metrics.wrongBranches());
  }
  catch (const InputError& error)
  {
    missing_.push_back(std::string("the errors of the metrics: ") + error.what());
  }
}

/** Adds instrument and branch to the chapters of wrong branches.
 *  @param entries time of each entry, at the rate of the samples [s], and its text */
void RecordedCourse::nameWrongBranches(std::vector<std::pair<double, std::string>> entries)
{
  for (PlayerChapter& chapter : chapters_)
  {
    const auto isOfChapter = [&chapter](const std::pair<double, std::string>& entry)
    { return std::abs(entry.first - chapter.time) < kSamplesApart; };
    const auto entry = std::find_if(entries.begin(), entries.end(), isOfChapter);
    if (chapter.kind != PlayerChapter::ERROR || chapter.name != kWrongBranch || entry == entries.end())
      continue;
    chapter.name += ": " + entry->second;
    entries.erase(entry);
  }
}

void RecordedCourse::addMarks(const BagTimeline& timeline)
{
  forEach(timeline, {"session/mark"},
          [&](const BagMessage& message)
          {
            CheckedStream in(message.data, message.size);
            std_msgs::Header header;
            std::uint64_t step = 0;
            double time = 0.0;
            std::string text;
            in.next(header);
            in.next(step);
            in.next(time);
            in.next(text);
            add(PlayerChapter::MARK, time, text);
          });
}

void RecordedCourse::addViews(const BagTimeline& timeline)
{
  forEach(timeline, {names::kCArmCommand},
          [&](const BagMessage& message) { views_[message.time] = message.read<CArm>()->view; });
}

void RecordedCourse::followForces(const BagTimeline& timeline)
{
  std::multimap<std::uint64_t, std::vector<double>> samples;
  std::map<std::uint64_t, double> nodes;
  forEach(timeline, {names::kSessionSample},
          [&](const BagMessage& message)
          {
            const auto sample = message.read<SessionSample>();
            samples.emplace(sample->step, sample->peak_hand_force);
          });
  forEach(timeline, {names::kRodStateVisual},
          [&](const BagMessage& message)
          {
            const auto rod = message.read<RodStateVisual>();
            samples.emplace(rod->step, rod->hand_force);
            nodes[rod->step] = std::max(nodes[rod->step], largestNodeForce(*rod));
          });
  std::vector<double> largest;
  double largest_node = 0.0;
  auto sample = samples.begin();
  auto node = nodes.begin();
  for (const RecordedState& state : timeline.states())
  {
    for (; sample != samples.end() && sample->first <= state.step; ++sample)
      followLargest(sample->second, largest);
    for (; node != nodes.end() && node->first <= state.step; ++node)
      largest_node = std::max(largest_node, node->second);
    hand_forces_.push_back(largest);
    node_forces_.push_back(largest_node);
  }
}

}  // namespace endovascular_sim::nodes
