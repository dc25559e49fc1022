#include "nodes/session/bag_results.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>

#include "common/error.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/SessionGap.h"
#include "endovascular_sim/SessionMark.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/SimulationRun.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/recorded_pictures.h"
#include "nodes/session/session_bag.h"
#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Interval of the pictures where the bag does not name it: the default of the session node [frames]. */
constexpr std::uint32_t kFormerInterval = 15;

/** Adds messages of one bag to results: for each topic what the session node does with it. */
class MessageFeed
{
public:
  explicit MessageFeed(SessionResults& results) : results_(results) {}

  /** @throws InputError for a message that the scene refuses, ros::Exception for a damaged one */
  void add(const BagMessage& message)
  {
    if (isTopic(message.topic, names::kDriveApplied))
      with<DriveApplied>(message, [this](const auto& step) { results_.add(*step); });
    else if (isTopic(message.topic, names::kRodStateVisual))
      with<RodStateVisual>(message, [this](const auto& rod) { results_.add(*rod); });
    else if (isTopic(message.topic, names::kContactForceMap))
      with<ContactForceMap>(message, [this](const auto& map) { results_.add(ContactForceMapConstPtr(map)); });
    else if (isTopic(message.topic, names::kVesselMesh))
      with<VesselMesh>(message, [this](const auto& mesh) { addMesh(mesh); });
    else if (isTopic(message.topic, names::kVesselCentreline))
      with<VesselCentreline>(message, [this](const auto& centreline) { results_.add(*centreline); });
    else if (isTopic(message.topic, names::kFluoroscopyCameraInfo))
      results_.report().addFluoroscopyFrame();
    else if (isTopic(message.topic, names::kSimulationRun))
      with<SimulationRun>(message, [this](const auto& run) { results_.report().setFirstStep(run->first_step); });
    else if (isTopic(message.topic, names::kSessionInfo))
      results_.report().setSubject(sessionInfo(message).subject);
    else if (isTopic(message.topic, names::kSessionGap))
      with<SessionGap>(message, [this](const auto& gap) { results_.add(*gap); });
    else if (isTopic(message.topic, names::kSessionMark))
      with<SessionMark>(message, [this](const auto& mark) { results_.add(*mark); });
    else if (message.topic == names::kDiagnostics)
      with<diagnostic_msgs::DiagnosticArray>(message, [this](const auto& array) { results_.add(*array); });
    else
      addMeasured(message);
  }

private:
  /** Messages of the metrics. */
  void addMeasured(const BagMessage& message)
  {
    if (isTopic(message.topic, names::kSessionSample))
      measure<SessionSample>(message);
    else if (isTopic(message.topic, names::kProcedureStep))
      measure<ProcedureStep>(message);
    else if (isTopic(message.topic, names::kTreatmentVisual))
      measure<TreatmentVisual>(message);
    else if (isTopic(message.topic, names::kWallDisplacement))
      measure<WallDisplacement>(message);
    else if (isTopic(message.topic, names::kHeartPhase))
      measure<HeartPhase>(message);
  }

  template <typename Message>
  void measure(const BagMessage& message)
  {
    with<Message>(message, [this](const auto& content) { results_.metrics().add(*content); });
  }

  template <typename Message, typename Use>
  static void with(const BagMessage& message, const Use& use)
  {
    if (!message.is<Message>())
      throw InputError(message.topic, "", "has the fields of another version");
    use(message.read<Message>());
  }

  /** The initial wall only: later ones are in vessel/wall_displacement already. */
  void addMesh(const VesselMeshConstPtr& mesh)
  {
    if (!std::exchange(has_mesh_, true))
      results_.add(mesh);
  }

  SessionResults& results_;
  bool has_mesh_ = false;
};

results::SessionIdentity recordedIdentity(const scene::Scene& scene, const SessionInfo& info)
{
  results::SessionIdentity identity = identityOf(scene);
  identity.scene_hash = info.scene_hash;
  identity.software_version = info.software_version;
  identity.commit = info.commit;
  identity.physics = info.physics_number;
  return identity;
}

void createFolder(const std::string& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder + "/fluoroscopy", error);
  if (error)
    throw InputError(folder, "--out", "the folder cannot be created (" + error.message() + "); choose another one");
}

/** Outcome of the recording whose last bag this is. */
results::RecordingOutcome outcomeOf(const std::vector<std::string>& files, const std::vector<BagOutline>& outlines)
{
  results::RecordingOutcome outcome;
  outcome.file = files.back();
  for (std::size_t k = 0; k + 1 < files.size(); ++k)
    outcome.previous.push_back(std::filesystem::path(files[k]).filename().string());
  for (std::size_t k = 0; k < files.size(); ++k)
  {
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(files[k], unknown);
    outcome.bytes += unknown ? 0 : bytes;
    outcome.messages += outlines[k].messages;
    outcome.dropped += outlines[k].end ? outlines[k].end->dropped : 0;
  }
  return outcome;
}

}  // namespace

BagOutline outlineOf(const std::string& file)
{
  BagOutline outline;
  outline.damage = readBagMessages(file,
                                   [&outline](const BagMessage& message)
                                   {
                                     ++outline.messages;
                                     try
                                     {
                                       if (isTopic(message.topic, names::kSessionInfo))
                                         outline.info = sessionInfo(message);
                                       else if (isTopic(message.topic, names::kSessionEnd) && message.is<SessionEnd>())
                                         outline.end = *message.read<SessionEnd>();
                                     }
                                     catch (const ros::Exception&)
                                     {
                                       // named by addBag() or readSessionBag()
                                     }
                                   });
  return outline;
}

std::uint64_t addBag(const std::string& file, SessionResults& results,
                     const std::function<void(const BagMessage&)>& also)
{
  MessageFeed feed(results);
  std::uint64_t left_out = 0;
  const auto tryTo = [&left_out](const auto& work)
  {
    try
    {
      work();
    }
    catch (const ros::Exception&)
    {
      ++left_out;
    }
    catch (const InputError&)
    {
      ++left_out;
    }
  };
  readBagMessages(file,
                  [&](const BagMessage& message)
                  {
                    tryTo([&] { feed.add(message); });
                    if (also)
                      tryTo([&] { also(message); });
                  });
  return left_out;
}

BagResultFiles writeResults(const std::vector<std::string>& files, const std::string& folder, bool pictures)
{
  ros::Time::init();  // without a node, ROS takes the time for a simulated one
  std::vector<BagOutline> outlines;
  std::transform(files.begin(), files.end(), std::back_inserter(outlines), outlineOf);
  const auto first = std::find_if(outlines.begin(), outlines.end(), [](const auto& outline) { return outline.info; });
  if (first == outlines.end())
    throw InputError(files.front(), names::kSessionInfo, "missing; only bags of the session node give results");
  const scene::Scene scene = scene::parseRecordedScene(first->info->scene_yaml, files.front());
  const std::optional<SessionEnd>& end = outlines.back().end;
  createFolder(folder);
  const bool has_limit = end && end->step_limit > 0;  // 0: recorded before the message had one
  SessionResults results(scene, recordedIdentity(scene, *first->info), folder,
                         has_limit ? end->step_limit : std::numeric_limits<std::uint64_t>::max());
  std::optional<RecordedPictures> drawn;
  const std::uint32_t interval = has_limit ? end->picture_interval : kFormerInterval;
  if (pictures && scene.fluoroscopy && interval > 0)
    drawn.emplace(scene, interval, folder);
  BagResultFiles outcome;
  for (const std::string& file : files)
    outcome.left_out += addBag(file, results,
                               [&drawn](const BagMessage& message)
                               {
                                 if (drawn)
                                   drawn->add(message);
                               });
  if (drawn)
    results.report().addFluoroscopyPictures(drawn->pictures());
  if (end && end->wall_time > 0.0)
    results.report().setWallTimes(end->wall_time, end->longest_pause);
  for (const BagOutline& outline : outlines)
    if (!outline.damage.empty())
      outcome.damage.push_back(outline.damage);
  const bool written = results.write(outcomeOf(files, outlines), end ? end->error : "the bag has no end (session/end)");
  outcome.verdict = results.verdict();
  outcome.is_complete = written && end && outcome.damage.empty() && outcome.left_out == 0;
  return outcome;
}

}  // namespace endovascular_sim::nodes
