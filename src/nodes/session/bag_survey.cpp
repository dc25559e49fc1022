#include "nodes/session/bag_survey.h"

#include <filesystem>
#include <functional>
#include <set>
#include <system_error>
#include <utility>

#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "endovascular_sim/BloodFlow.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/FlowNetwork.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionMark.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/SimulationRun.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/bag_records.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"

namespace endovascular_sim::nodes
{
namespace
{

using Json = nlohmann::ordered_json;

/** Reports whether a message has the fields that this version has for its topic; topics without a rule have. */
bool isOfThisVersion(const BagMessage& message)
{
  using Check = std::function<bool(const BagMessage&)>;
  static const std::vector<std::pair<const char*, Check>> checks = {
      {names::kSessionInfo, &BagMessage::is<SessionInfo>},
      {names::kDriveApplied, &BagMessage::is<DriveApplied>},
      {names::kVesselMesh, &BagMessage::is<VesselMesh>},
      {names::kVesselCentreline, &BagMessage::is<VesselCentreline>},
      {names::kSimulationRun, &BagMessage::is<SimulationRun>},
      {names::kSessionGap, &BagMessage::is<SessionGap>},
      {names::kSessionMark, &BagMessage::is<SessionMark>},
      {names::kSessionEnd, &BagMessage::is<SessionEnd>},
      {names::kSessionSample, &BagMessage::is<SessionSample>},
      {names::kRodStateVisual, &BagMessage::is<RodStateVisual>},
      {names::kTreatmentVisual, &BagMessage::is<TreatmentVisual>},
      {names::kWallDisplacement, &BagMessage::is<WallDisplacement>},
      {names::kProcedureStep, &BagMessage::is<ProcedureStep>},
      {names::kContactForces, &BagMessage::is<ContactForces>},
      {names::kContactForceMap, &BagMessage::is<ContactForceMap>},
      {names::kHemodynamicControls, &BagMessage::is<HemodynamicControls>},
      {names::kFlowNetwork, &BagMessage::is<FlowNetwork>},
      {names::kBloodFlow, &BagMessage::is<BloodFlow>},
      {names::kHeartPhase, &BagMessage::is<HeartPhase>},
      {names::kContrastCells, &BagMessage::is<ContrastCells>},
      {names::kContrastInjection, &BagMessage::is<ContrastInjection>},
      {names::kContrastState, &BagMessage::is<ContrastState>},
      {names::kMotionControls, &BagMessage::is<MotionControls>},
      {names::kMotionState, &BagMessage::is<MotionState>},
  };
  for (const auto& [topic, check] : checks)
    if (isTopic(message.topic, topic))
      return check(message);
  return true;
}

/** Collects a survey from the messages of a bag. */
class Surveyor
{
public:
  explicit Surveyor(BagSurvey& survey) : survey_(survey) {}

  void add(const BagMessage& message)
  {
    BagTopic& topic = survey_.topics[message.topic];
    if (topic.messages++ == 0)
    {
      topic.type = message.type;
      topic.md5sum = message.md5sum;
      topic.is_latched = message.is_latched;
      topic.is_of_other_version = !isOfThisVersion(message);
    }
    if (topic.is_of_other_version && !isTopic(message.topic, names::kSessionInfo))
      return;
    if (isTopic(message.topic, names::kSessionInfo))
      survey_.info = sessionInfo(message);
    else if (isTopic(message.topic, names::kDriveApplied))
      addStep(message.read<DriveApplied>()->step);
    else if (isTopic(message.topic, names::kSessionEnd))
      survey_.recorded_steps = message.read<SessionEnd>()->steps;
    else if (isTopic(message.topic, names::kSimulationRun))
      addRun(*message.read<SimulationRun>());
    else if (isTopic(message.topic, names::kSessionGap))
      survey_.outer_gaps.push_back(*message.read<SessionGap>());
    else if (isTopic(message.topic, names::kSessionMark))
      ++survey_.marks;
  }

  /** Completes the survey after the last message. */
  void finish()
  {
    survey_.steps = steps_.size();
    if (steps_.empty())
      return;
    survey_.first_step = *steps_.begin();
    survey_.last_step = *steps_.rbegin();
    std::uint64_t expected = survey_.first_step;
    for (const std::uint64_t step : steps_)
    {
      if (step != expected)
        survey_.gaps.push_back({expected, step - 1});
      expected = step + 1;
    }
  }

private:
  void addStep(std::uint64_t step)
  {
    survey_.repeated_steps += steps_.insert(step).second ? 0U : 1U;
    survey_.disordered_steps += step < *steps_.rbegin() ? 1U : 0U;
  }

  void addRun(const SimulationRun& run) { survey_.state_bytes = run.state.size(); }

  BagSurvey& survey_;
  std::set<std::uint64_t> steps_;
};

/** Topic of a survey that can be read, by its name without the namespace; null without one. */
const BagTopic* readable(const BagSurvey& survey, const char* name)
{
  for (const auto& [topic, content] : survey.topics)
    if (isTopic(topic, name) && !content.is_of_other_version)
      return &content;
  return nullptr;
}

/** Finds out up to which step a replay can compute the session, and why not further. */
void examineComputation(BagSurvey& survey, bool computes)
{
  try
  {
    const SessionBag recording = readSessionBag(survey.file);
    if (computes)
      RecordedSimulation(recording, survey.file);
    if (survey.first_step != recording.first_step)
    {
      survey.obstacle = "the first step of the recording, " + std::to_string(recording.first_step) + ", is missing";
      return;
    }
    survey.recomputed_to = survey.gaps.empty() ? survey.last_step : survey.gaps.front().first - 1;
    survey.obstacle = incompleteness(recording);
  }
  catch (const InputError& error)
  {
    survey.obstacle = error.what();
  }
}

/** Connection header of a message, which also tells whether its topic is latched. */
boost::shared_ptr<ros::M_string> headerOf(const BagMessage& message)
{
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = message.type;
  (*header)["md5sum"] = message.md5sum;
  (*header)["message_definition"] = message.definition;
  if (message.is_latched)
    (*header)["latching"] = "1";
  return header;
}

std::string plural(std::uint64_t count, const std::string& noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string textOfSteps(const BagSurvey& survey)
{
  if (survey.steps == 0)
    return "no step";
  std::string text = "steps " + std::to_string(survey.first_step) + " to " + std::to_string(survey.last_step);
  text += survey.recorded_steps ? " of " + std::to_string(*survey.recorded_steps) : ", without an end";
  for (const StepGap& gap : survey.gaps)
    text += "; " + std::to_string(gap.first) + " to " + std::to_string(gap.last) + " are missing";
  if (survey.repeated_steps > 0)
    text += "; " + plural(survey.repeated_steps, "step") + " twice";
  if (survey.disordered_steps > 0)
    text += "; " + plural(survey.disordered_steps, "step") + " in the wrong order";
  return text;
}

std::string textOfUses(const BagSurvey& survey)
{
  std::string text = std::string("show: ") + (survey.shows ? "yes" : "no") +
                     "; report: " + (survey.reports ? "yes" : "no") + "; recompute: ";
  if (!survey.recomputed_to)
    text += "no";
  else
    text += survey.obstacle.empty() ? "every step" : "up to step " + std::to_string(*survey.recomputed_to);
  return text;
}

}  // namespace

BagSurvey surveyBag(const std::string& file, bool computes)
{
  BagSurvey survey;
  survey.file = file;
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
  survey.bytes = unknown ? 0 : bytes;
  Surveyor surveyor(survey);
  std::string unreadable;
  try
  {
    survey.damage = readBagMessages(file,
                                    [&](const BagMessage& message)
                                    {
                                      try
                                      {
                                        surveyor.add(message);
                                      }
                                      catch (const ros::Exception&)  // the bytes of the message are damaged
                                      {
                                        unreadable = "a message of " + message.topic.substr(0, 100) + " cannot be read";
                                      }
                                    });
  }
  catch (const InputError& error)
  {
    survey.refusal = survey.obstacle = error.what();
    return survey;
  }
  if (survey.damage.empty())
    survey.damage = unreadable;
  surveyor.finish();
  survey.shows = readable(survey, names::kRodStateVisual) != nullptr && survey.info;
  survey.reports = readable(survey, names::kSessionSample) != nullptr &&
                   readable(survey, names::kDriveApplied) != nullptr && survey.info;
  examineComputation(survey, computes);
  return survey;
}

std::uint64_t repairBag(const std::string& file, const std::string& copy)
{
  std::uint64_t messages = 0;
  try
  {
    rosbag::Bag repaired(copy, rosbag::bagmode::Write);
    repaired.setCompression(rosbag::compression::LZ4);
    readBagMessages(file,
                    [&](const BagMessage& message)
                    {
                      topic_tools::ShapeShifter content;
                      content.morph(message.md5sum, message.type, message.definition, message.is_latched ? "1" : "0");
                      ros::serialization::IStream bytes(const_cast<std::uint8_t*>(message.data), message.size);
                      content.read(bytes);
                      repaired.write(message.recorded_topic, std::max(message.time, ros::TIME_MIN), content,
                                     headerOf(message));
                      ++messages;
                    });
    repaired.close();
  }
  catch (const rosbag::BagException& error)
  {
    throw InputError(copy, "", std::string("cannot be written (") + error.what() + "); choose another file");
  }
  return messages;
}

nlohmann::ordered_json toJson(const BagSurvey& survey)
{
  Json json = {{"file", survey.file}, {"bytes", survey.bytes}, {"complete", survey.isComplete()}};
  json["refusal"] = survey.refusal.empty() ? Json(nullptr) : Json(survey.refusal);
  json["damage"] = survey.damage.empty() ? Json(nullptr) : Json(survey.damage);
  if (survey.info)
    json["session"] = {{"scene", survey.info->scene_name},
                       {"version", survey.info->software_version},
                       {"commit", survey.info->commit},
                       {"physics", survey.info->physics_number},
                       {"time_step", survey.info->time_step},
                       {"subject", survey.info->subject},
                       {"continues_from_state", survey.state_bytes > 0}};
  json["steps"] = {{"number", survey.steps},
                   {"first", survey.first_step},
                   {"last", survey.last_step},
                   {"repeated", survey.repeated_steps},
                   {"disordered", survey.disordered_steps}};
  json["steps"]["recorded"] = survey.recorded_steps ? Json(*survey.recorded_steps) : Json(nullptr);
  json["steps"]["gaps"] = Json::array();
  for (const StepGap& gap : survey.gaps)
    json["steps"]["gaps"].push_back({{"first", gap.first}, {"last", gap.last}});
  json["gaps_between_bags"] = Json::array();
  for (const SessionGap& gap : survey.outer_gaps)
    json["gaps_between_bags"].push_back(
        {{"first", gap.first_step}, {"last", gap.last_step}, {"previous", gap.previous}, {"next", gap.next}});
  json["marks"] = survey.marks;
  json["uses"] = {{"show", survey.shows}, {"report", survey.reports}};
  json["uses"]["recompute_to"] = survey.recomputed_to ? Json(*survey.recomputed_to) : Json(nullptr);
  json["uses"]["obstacle"] = survey.obstacle.empty() ? Json(nullptr) : Json(survey.obstacle);
  json["topics"] = Json::array();
  for (const auto& [name, topic] : survey.topics)
    json["topics"].push_back({{"topic", name},
                              {"type", topic.type},
                              {"md5", topic.md5sum},
                              {"messages", topic.messages},
                              {"latched", topic.is_latched},
                              {"other_version", topic.is_of_other_version}});
  return json;
}

std::string textOf(const BagSurvey& survey)
{
  if (!survey.refusal.empty())
    return survey.refusal + "\n  " + textOfUses(survey) + "\n";
  std::string text = survey.file + ": ";
  text += survey.info
              ? "session of " + survey.info->scene_name + ", version " + survey.info->software_version + ", commit " +
                    survey.info->commit + ", physics " + std::to_string(survey.info->physics_number)
              : "no session/info";
  text += "\n  " + textOfSteps(survey) + (survey.state_bytes > 0 ? "; continues from a saved state" : "") + "\n";
  for (const SessionGap& gap : survey.outer_gaps)
    text += "  steps " + std::to_string(gap.first_step) + " to " + std::to_string(gap.last_step) +
            " are in no bag: between " + (gap.previous.empty() ? "the beginning of the run" : gap.previous) + " and " +
            gap.next + "\n";
  if (survey.info && !survey.info->subject.empty())
    text += "  subject: " + survey.info->subject + "\n";
  text += "  " + (survey.damage.empty() ? "no damage" : "damaged: " + survey.damage) + "\n";
  for (const auto& [name, topic] : survey.topics)
    if (topic.is_of_other_version)
      text += "  " + name + ": has the fields of another version\n";
  text += "  " + textOfUses(survey) + "\n";
  if (!survey.obstacle.empty())
    text += "  " + survey.obstacle + "\n";
  return text;
}

}  // namespace endovascular_sim::nodes
