#include "nodes/rod_dynamics/instruments/graph_hardware.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kQueue = 1000;  ///< messages of a sensor that wait for a slow subscriber
constexpr auto kNoFault = "none";

/** Index of a word. @return none for an unknown one */
std::optional<std::size_t> indexOf(const std::vector<std::string>& words, const std::string& word)
{
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    return std::nullopt;
  return static_cast<std::size_t>(found - words.begin());
}

/** Fault of a request, with a start of 0.
 *  @param duration [s]; 0: no end
 *  @return reason of a refusal; else empty */
std::string readFault(const SetFault::Request& request, robot::FaultSettings& fault)
{
  const std::optional<std::size_t> axis = indexOf(robot::axisWords(), request.axis);
  if (!axis)
    return "axis is '" + request.axis + "'; must be insertion or rotation";
  fault.axis = static_cast<robot::FaultAxis>(*axis);
  if (request.kind == kNoFault)
    return "";
  const std::optional<std::size_t> kind = indexOf(robot::faultWords(), request.kind);
  if (!kind)
    return "kind is '" + request.kind + "'; must be stuck, slipping, delayed, backlash or none";
  fault.kind = static_cast<robot::FaultKind>(*kind);
  fault.amount = request.amount;
  fault.seed = request.seed;
  if (request.probability != 0.0)
    fault.probability = request.probability;
  if (request.interval != 0.0)
    fault.interval = request.interval;
  if (!std::isfinite(request.duration) || request.duration < 0.0)
    return "duration must be 0 or more";
  return robot::refusalOf(fault);
}

const char* frameOf(sensor::SensorKind kind)
{
  switch (kind)
  {
    case sensor::SensorKind::kEmTracker:
      return names::kPatientFrame;
    case sensor::SensorKind::kDetector:
      return "";
    default:
      return names::kIntroducerFrame;
  }
}

}  // namespace

GraphHardware::GraphHardware(ros::NodeHandle& node, const scene::Scene& scene) : scene_(scene)
{
  for (const sensor::SensorSettings& sensor : scene_.sensors)
    publishers_.push_back(node.advertise<SensorReading>(names::kSensors + sensor.name, kQueue));
  for (std::size_t k = 0; k < scene_.instruments.size(); ++k)
    advertiseFaults(node, k);
  spinner_.start();
}

void GraphHardware::advertiseFaults(ros::NodeHandle& node, std::size_t instrument)
{
  const boost::function<bool(SetFault::Request&, SetFault::Response&)> call =
      [this, instrument](SetFault::Request& request, SetFault::Response& response)
  {
    setFault(instrument, request, response);
    return true;
  };
  const std::string& name = scene_.instruments[instrument].instrument.name;
  ros::AdvertiseServiceOptions options;
  options.init<SetFault::Request, SetFault::Response>(names::kInstruments + name + names::kFault, call);
  options.callback_queue = &queue_;  // of a thread of its own: also between two steps and in a pause
  services_.push_back(node.advertiseService(options));
}

/** Called in a thread of ROS. */
void GraphHardware::setFault(std::size_t instrument, const SetFault::Request& request, SetFault::Response& response)
{
  Change change;
  change.fault.instrument = instrument;
  change.removes = request.kind == kNoFault;
  change.duration = request.duration;
  const std::string refusal = readFault(request, change.fault);
  const std::string& name = scene_.instruments[instrument].instrument.name;
  response.success = refusal.empty() ? 1 : 0;
  response.message = refusal;
  if (!refusal.empty())
  {
    ROS_WARN("%s: refused a fault: %s", name.c_str(), refusal.c_str());
    return;
  }
  response.message = name + ", " + request.axis + ": " +
                     (change.removes ? "no fault from the next step on" : request.kind + " from the next step on");
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  changes_.push_back(change);
  has_changes_ = true;
}

void GraphHardware::applyChanges(session::Session& session)
{
  if (!has_changes_)
    return;
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  for (Change& change : changes_)
  {
    if (change.removes)
    {
      session.removeFaults(static_cast<int>(change.fault.instrument), change.fault.axis);
      continue;
    }
    change.fault.start = session.simulation().time();
    if (change.duration > 0.0)
      change.fault.end = change.fault.start + change.duration;
    session.addFault(change.fault);
  }
  changes_.clear();
  has_changes_ = false;
}

void GraphHardware::publish(std::size_t sensor, const session::Session& session, ros::Time stamp)
{
  const simulation::Sensors& sensors = session.observe().sensors();
  const sensor::Reading& reading = sensors.reading(sensor);
  const std::uint64_t steps = session.simulation().steps();
  const double age = static_cast<double>(steps - reading.step) * scene_.solver.time_step;
  message_.header.stamp = stamp.toSec() > age ? stamp - ros::Duration(age) : ros::Time();
  message_.header.frame_id = frameOf(sensors.settings(sensor).kind);
  message_.sequence = reading.sequence;
  message_.step = reading.step;
  message_.delivered_step = steps;
  message_.time = static_cast<double>(reading.step) * scene_.solver.time_step;
  message_.valid = reading.valid ? 1 : 0;
  message_.values = reading.values;
  publishers_[sensor].publish(message_);
}

void GraphHardware::publishStep(const session::Session& session, ros::Time stamp)
{
  for (std::size_t k = 0; k < publishers_.size(); ++k)
    if (session.observe().sensors().isNew(k))
      publish(k, session, stamp);
}

}  // namespace endovascular_sim::nodes
