#include "nodes/expert/expert_recording.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/ProcedureStep.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/session_files.h"
#include "nodes/visualization/motion_history.h"

namespace endovascular_sim::nodes
{

ExpertRecording::ExpertRecording(const std::string& folder)
  : timeline_(bagsOfOneSession({folder})),
    states_(timeline_.entriesOf({names::kRodStateVisual})),
    treatments_(timeline_.entriesOf({names::kTreatmentVisual})),
    steps_(timeline_.entriesOf({names::kProcedureStep})),
    motions_(timeline_.entriesOf({names::kMotionState})),
    course_(momentsOf())
{
}

/** Moments of all recorded states, each with the step of the procedure that had begun by then. */
std::vector<RunMoment> ExpertRecording::momentsOf() const
{
  struct Begun
  {
    double time;
    std::size_t step;
  };
  std::vector<Begun> begun;
  for (const std::uint32_t entry : steps_)
  {
    const auto step = timeline_.message(entry).read<ProcedureStep>();
    begun.push_back({step->begin, std::max(step->step_of_procedure, 1U)});
  }
  std::vector<RunMoment> moments;
  std::size_t next = 0, step = 0;
  for (const std::uint32_t entry : states_)
  {
    const auto state = timeline_.message(entry).read<RodStateVisual>();
    for (; next < begun.size() && begun[next].time <= state->time; ++next)
      step = begun[next].step;
    moments.push_back({state->time, state->insertion, step});
  }
  const auto falls = [](const RunMoment& a, const RunMoment& b) { return b.time < a.time; };
  if (moments.empty() || std::adjacent_find(moments.begin(), moments.end(), falls) != moments.end())
    throw InputError(timeline_.files().front(), names::kRodStateVisual,
                     "is missing, or its times fall; give the results of one run as the expert");
  return moments;
}

RodStateVisual ExpertRecording::state(std::size_t moment) const
{
  return *timeline_.message(states_.at(moment)).read<RodStateVisual>();
}

/** Last one of entries of one topic at or before a moment; empty before the first one. */
std::optional<std::uint32_t> ExpertRecording::lastUpTo(std::size_t moment,
                                                       const std::vector<std::uint32_t>& entries) const
{
  const ros::Time time = timeline_.entries()[states_.at(moment)].time;
  const auto isLater = [this](ros::Time at, std::uint32_t entry) { return at < timeline_.entries()[entry].time; };
  const auto after = std::upper_bound(entries.begin(), entries.end(), time, isLater);
  return after == entries.begin() ? std::nullopt : std::optional<std::uint32_t>(*(after - 1));
}

std::optional<TreatmentVisual> ExpertRecording::treatment(std::size_t moment) const
{
  const std::optional<std::uint32_t> entry = lastUpTo(moment, treatments_);
  if (!entry)
    return std::nullopt;
  return *timeline_.message(*entry).read<TreatmentVisual>();
}

motion::MotionMap ExpertRecording::motion(std::size_t moment) const
{
  const std::optional<std::uint32_t> entry = lastUpTo(moment, motions_);
  return entry ? fromMessage(*timeline_.message(*entry).read<MotionState>()) : restingMap();
}

std::optional<geometry_msgs::Point> tipOf(const RodStateVisual& state)
{
  return state.nodes.empty() ? std::nullopt : std::optional<geometry_msgs::Point>(state.nodes.back());
}

double tipDistance(const RodStateVisual& a, const RodStateVisual& b)
{
  const std::optional<geometry_msgs::Point> p = tipOf(a), q = tipOf(b);
  return p && q ? std::hypot(p->x - q->x, p->y - q->y, p->z - q->z) : std::nan("");
}

}  // namespace endovascular_sim::nodes
