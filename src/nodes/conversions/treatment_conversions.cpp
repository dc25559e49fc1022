#include "nodes/conversions/treatment_conversions.h"

#include "common/error.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/runtime/ros_names.h"
#include "results/treatment_report.h"

namespace endovascular_sim::nodes
{
namespace
{

TreatmentBody toMessage(const intervention::RoundBody& body, int instrument, double thickness)
{
  TreatmentBody message;
  message.instrument = static_cast<std::uint32_t>(instrument);
  for (const Eigen::Vector3d& point : body.axis)
    message.axis.push_back(toPoint(point));
  message.radius = body.radii;
  message.thickness = thickness;
  return message;
}

}  // namespace

void toMessage(const simulation::Simulation& simulation, TreatmentVisual& message)
{
  message.balloons.clear();
  message.stents.clear();
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    const intervention::Treatment* treatment = simulation.treatment(k);
    if (treatment == nullptr)
      continue;
    const intervention::RoundBody& balloon = treatment->load().balloon;
    if (!balloon.axis.empty())
      message.balloons.push_back(toMessage(balloon, k, 0.0));
    if (treatment->stent() && !treatment->stent()->sleeve().axis.empty())
    {
      message.stents.push_back(toMessage(treatment->stent()->sleeve(), k, treatment->stent()->strutThickness()));
      message.stents.back().opened = results::isOpened(*treatment->stent());
    }
  }
  message.event.clear();
  message.event_time.clear();
  message.event_instrument.clear();
  for (const simulation::TimedEvent& event : simulation.events())
  {
    message.event.emplace_back(simulation::nameOf(event.event));
    message.event_time.push_back(event.time);
    message.event_instrument.push_back(static_cast<std::uint32_t>(event.instrument));
  }
}

intervention::RoundBody fromMessage(const TreatmentBody& body)
{
  if (body.axis.size() != body.radius.size() || body.axis.size() < 2)
    throw InputError(names::kTreatmentVisual, "axis, radius", "must have the same length, at least two points");
  if (!(body.thickness >= 0.0 && body.thickness < 0.1))
    throw InputError(names::kTreatmentVisual, "thickness", "must be finite, at least 0 and less than 0.1 m");
  return roundBody(body.axis, body.radius, names::kTreatmentVisual);
}

simulation::ImagedTreatment imagedTreatment(const TreatmentVisual& message)
{
  simulation::ImagedTreatment imaged;
  for (const TreatmentBody& body : message.balloons)
    imaged.balloons.push_back(fromMessage(body));
  for (const TreatmentBody& body : message.stents)
    imaged.stents.push_back({fromMessage(body), body.thickness});
  return imaged;
}

}  // namespace endovascular_sim::nodes
