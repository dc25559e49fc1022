#include "rviz_plugin/model/scene_summary.h"

#include <algorithm>

#include "instrument/instrument.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_file.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

visualization::InstrumentShape shapeOf(const instrument::Instrument& instrument)
{
  visualization::InstrumentShape shape;
  shape.name = instrument.name;
  shape.is_hollow = instrument.inner_radius > 0.0;
  double end = 0.0;
  for (auto section = instrument.wire.sections.rbegin(); section != instrument.wire.sections.rend(); ++section)
  {
    end += section->length;
    shape.ends.push_back(end);
    shape.outer_radii.push_back(section->radius);
  }
  return shape;
}

/** Longest edge of the nodes, which all instruments share [m]. */
double edgeOf(const scene::Scene& scene)
{
  return scene.sampling.kind == scene::SamplingKind::kAdaptive
             ? scene.sampling.max_edge
             : scene.longest() / std::max(scene.sampling.nodes - 1, 1);
}

/** Insertion at which the proximal end fills the introducer's guide (rod::maxInsertion()). */
double largestInsertion(const scene::Scene& scene, double length)
{
  return length - scene.solver.guide_length - 3.0 * edgeOf(scene);
}

/** Names of the instruments that neither fit into another one nor take it into their lumen. */
std::vector<std::string> conflictsOf(const scene::Scene& scene, std::size_t instrument)
{
  std::vector<std::string> names;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (k != instrument && !instrument::fitsInside(scene.instruments[std::min(k, instrument)].instrument,
                                                   scene.instruments[std::max(k, instrument)].instrument))
      names.push_back(scene.instruments[k].instrument.name);
  return names;
}

std::vector<StepSummary> stepsOf(const scene::ProcedureScene& procedure)
{
  std::vector<StepSummary> steps;
  for (const scene::StepScene& step : procedure.steps)
  {
    const std::string& goal = step.until.tip_in.empty() ? step.until.balloon_in : step.until.tip_in;
    if (step.action != scene::StepAction::kExchange)
    {
      steps.push_back({step.instrument, step.hint, goal});
      continue;
    }
    steps.push_back({step.instrument, step.hint, {}});
    steps.push_back({step.replacement, step.hint, goal});
  }
  return steps;
}

InstrumentSummary summaryOf(const scene::DrivenInstrument& driven)
{
  InstrumentSummary summary;
  summary.shape = shapeOf(driven.instrument);
  summary.length = driven.instrument.wire.length();
  summary.force_limit = driven.drive.force_limit;
  summary.torque_limit = driven.drive.torque_limit;
  summary.largest_speed = driven.drive.limits.speed;
  summary.largest_turning_speed = driven.drive.limits.turning_speed;
  summary.takes_commands =
      driven.drive.source == scene::DriveSource::kTopic || driven.drive.source == scene::DriveSource::kDevice;
  if (driven.instrument.balloon)
  {
    summary.has_balloon = true;
    summary.balloon = *driven.instrument.balloon;
  }
  return summary;
}

}  // namespace

std::vector<visualization::InstrumentShape> SceneSummary::shapes() const
{
  std::vector<visualization::InstrumentShape> shapes;
  for (const InstrumentSummary& instrument : instruments)
    shapes.push_back(instrument.shape);
  return shapes;
}

SceneSummary sceneSummary(const SessionInfo& info)
{
  const scene::Scene scene = scene::parseRecordedScene(info.scene_yaml, nodes::names::kSessionInfo);
  SceneSummary summary;
  summary.name = info.scene_name;
  summary.duration = scene.duration;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
  {
    InstrumentSummary& instrument = summary.instruments.emplace_back(summaryOf(scene.instruments[k]));
    instrument.largest_insertion = largestInsertion(scene, instrument.length);
    instrument.outside_insertion = -scene.solver.guide_length - 2.0 * edgeOf(scene);  // rod::outsideInsertion()
    instrument.conflicts = conflictsOf(scene, k);
  }
  for (const scene::DrivenInstrument& driven : scene.instruments)
    if (scene.flow && instrument::pressureLineOf(driven.instrument))
    {
      summary.pressure_lines.push_back(driven.instrument.name);
      summary.pressure_frames.push_back(driven.instrument.name + nodes::names::kTipFrameOf);
    }
  if (scene.contrast)
    summary.syringe = scene.contrast->syringe();
  if (scene.procedure)
  {
    summary.steps = stepsOf(*scene.procedure);
    summary.is_guided = scene.procedure->guided;
  }
  return summary;
}

}  // namespace endovascular_sim::rviz_plugin
