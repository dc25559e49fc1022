#include "rviz_plugin/model/scene_summary.h"

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

InstrumentSummary summaryOf(const scene::DrivenInstrument& driven)
{
  InstrumentSummary summary;
  summary.shape = shapeOf(driven.instrument);
  summary.length = driven.instrument.wire.length();
  summary.force_limit = driven.drive.force_limit;
  summary.largest_speed = driven.drive.limits.speed;
  summary.largest_turning_speed = driven.drive.limits.turning_speed;
  summary.takes_commands =
      driven.drive.source == scene::DriveSource::kTopic || driven.drive.source == scene::DriveSource::kDevice;
  if (driven.instrument.balloon)
  {
    summary.has_balloon = true;
    summary.nominal_pressure = driven.instrument.balloon->nominal_pressure;
    summary.rated_pressure = driven.instrument.balloon->rated_burst_pressure;
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
  for (const scene::DrivenInstrument& driven : scene.instruments)
    summary.instruments.push_back(summaryOf(driven));
  return summary;
}

}  // namespace endovascular_sim::rviz_plugin
