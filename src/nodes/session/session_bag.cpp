#include "nodes/session/session_bag.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "common/error.h"
#include "common/hash.h"
#include "common/releases.h"
#include "common/version.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SimulationRun.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/flow_conversions.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Session info of another version. New fields are appended to the message only: the known ones are at its beginning.
 */
SessionInfo infoOfOtherVersion(const BagMessage& message)
{
  CheckedStream in(message.data, message.size);
  SessionInfo info;
  in.next(info.header);
  in.next(info.scene_name);
  in.next(info.scene_yaml);
  in.next(info.scene_hash);
  in.next(info.mesh_hash);
  in.next(info.seed);
  in.next(info.time_step);
  in.next(info.software_version);
  if (in.getLength() == 0)
    return info;  // recorded before the message had a commit and a physics number
  in.next(info.commit);
  in.next(info.physics_number);
  return info;
}

void requireSamePhysics(const std::string& file, const SessionInfo& info)
{
  if (info.physics_number == kPhysicsNumber)
    return;
  const std::string here = "; this program has physics " + std::to_string(kPhysicsNumber) + " (version " + version() +
                           ", commit " + commit() + ")";
  if (info.physics_number == 0)
    throw InputError(file, names::kSessionInfo,
                     "holds no physics number: version " + info.software_version + " recorded it" + here +
                         "; replay it with version " + info.software_version +
                         ", at the commit from which it was recorded");
  const std::string release = releaseOfPhysics(info.physics_number);
  throw InputError(file, names::kSessionInfo,
                   "has physics " + std::to_string(info.physics_number) + ", recorded by version " +
                       info.software_version + ", commit " + info.commit + here + "; replay it with " +
                       (release.empty() ? "a build of commit " + info.commit : release));
}

/** Message of a type of this version.
 *  @throws InputError when it has the fields of another version */
template <typename Message>
boost::shared_ptr<Message> readMessage(const std::string& file, const char* topic, const BagMessage& message)
{
  if (!message.is<Message>())
    throw InputError(file, topic,
                     "has the fields of another version; replay it with a build of the commit that recorded it "
                     "(rostopic echo -b FILE -n 1 /session/info)");
  return message.read<Message>();
}

/** Parts of a bag that are put together at its end. */
struct BagParts
{
  std::optional<SessionInfo> info;
  std::uint32_t run = 0;  ///< number of the run
  // Of this run and the one before:
  std::vector<boost::shared_ptr<HemodynamicControls>> controls;
  std::vector<boost::shared_ptr<MotionControls>> motion_controls;
  std::vector<boost::shared_ptr<ContrastInjection>> injections;
};

/** Adds a message to the content of a session. */
void addMessage(const std::string& file, const BagMessage& message, BagParts& parts, SessionBag& session)
{
  if (isTopic(message.topic, names::kSessionInfo))
  {
    parts.info = sessionInfo(message);
    requireSamePhysics(file, *parts.info);  // first, so that it is reported before differences of other messages
  }
  else if (isTopic(message.topic, names::kDriveApplied))
  {
    const auto applied = readMessage<DriveApplied>(file, names::kDriveApplied, message);
    session.steps[applied->step] = applied;
  }
  else if (isTopic(message.topic, names::kVesselMesh) && !session.mesh)
    session.mesh = readMessage<VesselMesh>(file, names::kVesselMesh, message);
  else if (isTopic(message.topic, names::kVesselCentreline) && !session.centreline)
    session.centreline = readMessage<VesselCentreline>(file, names::kVesselCentreline, message);
  else if (isTopic(message.topic, names::kSimulationRun))
  {
    const auto run = readMessage<SimulationRun>(file, names::kSimulationRun, message);
    session.first_step = run->first_step;
    parts.run = run->run;
    session.state.assign(run->state.begin(), run->state.end());
  }
  else if (isTopic(message.topic, names::kHemodynamicControls))
    parts.controls.push_back(readMessage<HemodynamicControls>(file, names::kHemodynamicControls, message));
  else if (isTopic(message.topic, names::kMotionControls))
    parts.motion_controls.push_back(readMessage<MotionControls>(file, names::kMotionControls, message));
  else if (isTopic(message.topic, names::kContrastInjection))
    parts.injections.push_back(readMessage<ContrastInjection>(file, names::kContrastInjection, message));
  else if (isTopic(message.topic, names::kSessionEnd))
    session.recorded_steps = readMessage<SessionEnd>(file, names::kSessionEnd, message)->steps;
}

/** Checks the text of the scene against its hash, and the vessel against that of the session.
 *  @throws InputError when they differ */
void requireUndamaged(const std::string& file, const SessionBag& session)
{
  Hash64 hash;
  hash.add(session.info.scene_yaml.data(), session.info.scene_yaml.size());
  if (hash.value() != session.info.scene_hash)
    throw InputError(file, names::kSessionInfo,
                     "the scene does not match its hash: the bag is damaged; use a copy that is intact");
  if (session.mesh && session.mesh->content_hash != session.info.mesh_hash)
    throw InputError(file, names::kVesselMesh,
                     "is not the vessel of session/info: the bag is damaged; use a copy that is intact");
}

std::string damageOf(const SessionBag& session)
{
  return session.damage.empty() ? "" : "; the bag is damaged: " + session.damage;
}

}  // namespace

bool isTopic(const std::string& topic, const std::string& name)
{
  return topic.size() > name.size() &&
         topic.compare(topic.size() - name.size() - 1, std::string::npos, "/" + name) == 0;
}

SessionInfo sessionInfo(const BagMessage& message)
{
  return message.is<SessionInfo>() ? *message.read<SessionInfo>() : infoOfOtherVersion(message);
}

SessionBag readSessionBag(const std::string& file)
{
  SessionBag session;
  BagParts parts;
  std::string unreadable;
  const auto add = [&](const BagMessage& message)
  {
    try
    {
      addMessage(file, message, parts, session);
    }
    catch (const ros::Exception&)  // the bytes of the message are damaged
    {
      unreadable = "a message of " + message.topic.substr(0, 100) + " cannot be read";
    }
  };
  session.damage = readBagMessages(file, add);
  if (session.damage.empty())
    session.damage = unreadable;
  if (!parts.info)
    throw InputError(file, names::kSessionInfo,
                     "missing; only bags of the session node can be replayed" + damageOf(session));
  session.info = *parts.info;
  for (const auto& controls : parts.controls)
    if (controls->run == parts.run)
      session.controls[controls->step] = fromMessage(*controls);
  for (const auto& controls : parts.motion_controls)
    if (controls->run == parts.run)
      session.motion_controls[controls->step] = fromMessage(*controls);
  for (const auto& injection : parts.injections)
    if (injection->run == parts.run)
      session.injections[injection->step].push_back(fromMessage(*injection));
  requireUndamaged(file, session);
  if (session.steps.empty())
    throw InputError(file, names::kDriveApplied, "holds no step; record a session that steps" + damageOf(session));
  return session;
}

std::string incompleteness(const SessionBag& session)
{
  const std::uint64_t found = session.steps.size();
  const std::uint64_t end = session.first_step + found;
  if (session.recorded_steps && *session.recorded_steps == end && session.steps.rbegin()->first + 1 == end)
    return session.damage.empty() ? "" : "the bag is damaged: " + session.damage;
  std::string reason =
      session.recorded_steps
          ? "the bag holds " + std::to_string(found) + " of the session's " +
                std::to_string(*session.recorded_steps - std::min(*session.recorded_steps, session.first_step)) +
                " steps"
          : "the bag has no end (session/end)";
  return reason + damageOf(session);
}

}  // namespace endovascular_sim::nodes
