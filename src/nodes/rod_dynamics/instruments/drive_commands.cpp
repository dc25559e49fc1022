#include "nodes/rod_dynamics/instruments/drive_commands.h"

#include <algorithm>
#include <limits>

#include <std_msgs/Empty.h>

#include "common/archive.h"
#include "common/error.h"
#include "nodes/conversions/command_topics.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
DriveCommands::DriveCommands(ros::NodeHandle& node, const scene::Scene& scene, const std::string& file)
  : scene_(scene), subscribers_(scene.instruments.size())
{
  if (!file.empty())
  {
    file_.emplace(scene, file, drive::readCommandFile(file));
    const double end = std::numeric_limits<double>::infinity();  // the graph runs until it is stopped
    file_->requireCommandsBefore(end);
    for (const std::string& warning : file_->warnings(end))
      ROS_WARN("%s", warning.c_str());
  }
  reset();
  for (std::size_t k = 0; k < scene_.instruments.size(); ++k)
    if (hands_->control(k) != nullptr)
      subscribe(node, k);
}

void DriveCommands::subscribe(ros::NodeHandle& node, std::size_t instrument)
{
  // Callbacks run in the thread that reads the socket; only the simulation's thread has a higher priority.
  const std::string name = names::kInstruments + scene_.instruments[instrument].instrument.name;
  for (const CommandTopic& topic : kCommandTopics)
    subscribers_[instrument].push_back(subscribeToCommands<sensor_msgs::JointState>(
        node, name + topic.name, &queue_,
        [this, instrument, kind = topic.kind](const ros::MessageEvent<sensor_msgs::JointState const>& event)
        { receive(instrument, kind, event); }));
  for (const WordTopic& topic : kWordTopics)
    subscribers_[instrument].push_back(
        subscribeToCommands<std_msgs::Empty>(node, name + topic.name, &queue_,
                                             [this, instrument, word = topic.word](const auto& event)
                                             { receiveWord(instrument, event.getPublisherName(), word); }));
  subscribers_[instrument].push_back(subscribeToCommands<crtk_msgs::StringStamped>(
      node, name + names::kStateCommand, &queue_,
      [this, instrument](const ros::MessageEvent<crtk_msgs::StringStamped const>& event)
      { receiveWord(instrument, event.getPublisherName(), event.getConstMessage()->string); }));
}

void DriveCommands::receive(std::size_t instrument, drive::CommandKind kind,
                            const ros::MessageEvent<sensor_msgs::JointState const>& event)
{
  const sensor_msgs::JointState& message = *event.getConstMessage();
  const std::optional<drive::JointCommand> command = drive::jointCommand(kind, message.name, valuesOf(message, kind));
  const std::lock_guard<std::mutex> lock(mutex_);
  drive::HandControl& control = *hands_->control(instrument);
  if (control.command(event.getPublisherName(), command) != drive::CommandVerdict::kAccepted)
    ROS_WARN_THROTTLE(5.0, "%s: rejected a %s", scene_.instruments[instrument].instrument.name.c_str(),
                      control.arbiter().lastRefusal().c_str());
  updateRevision();
}

/** Executes a command without values. */
void DriveCommands::receiveWord(std::size_t instrument, const std::string& client, const std::string& word)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  drive::HandControl& control = *hands_->control(instrument);
  const std::string& name = scene_.instruments[instrument].instrument.name;
  if (control.stateCommand(client, word))
    ROS_INFO("%s: %s by %s: %s", name.c_str(), word.c_str(), client.c_str(), drive::nameOf(control.state().state));
  else
    ROS_WARN_THROTTLE(5.0, "%s: rejected a %s", name.c_str(), control.arbiter().lastRefusal().c_str());
  updateRevision();
}

std::string DriveCommands::give(const std::string& client, const std::vector<InstrumentCommand>& commands)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  simulation::DrivenHands before = *hands_;
  std::string refusal;
  for (std::size_t n = 0; n < commands.size() && refusal.empty(); ++n)
    refusal = giveOne(client, commands[n], n);
  if (!refusal.empty())
  {
    before.copyRejections(*hands_);
    hands_.emplace(before);
  }
  updateRevision();
  return refusal;
}

/** @param n index of the command in its call. @return reason of a refusal */
std::string DriveCommands::giveOne(const std::string& client, const InstrumentCommand& command, std::size_t n)
{
  const std::string where = "commands[" + std::to_string(n) + "]";
  try
  {
    drive::HandControl& control =
        *hands_->control(simulation::commandedInstrument(scene_, command.instrument, client, where));
    const std::optional<drive::CommandKind> kind = drive::commandKind(command.command);
    if (!kind && !drive::isStateCommand(command.command))
      return where + ": unknown command '" + command.command +
             "'; known are servo_jp, servo_jr, servo_jv, servo_jf, move_jp, move_jr, " + drive::kStateCommands;
    const bool accepted = drive::give(control, client, command.command, command.joints.name,
                                      kind ? valuesOf(command.joints, *kind) : std::vector<double>());
    return accepted ? "" : where + ": " + command.instrument + ": " + control.arbiter().lastRefusal();
  }
  catch (const InputError& error)
  {
    return error.what();
  }
}

void DriveCommands::reset()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  hands_.emplace(scene_);
  grips_.assign(scene_.instruments.size(), {});
  player_ = file_;
  updateRevision();
}

void DriveCommands::restAt(const simulation::Simulation& simulation)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  hands_->restAt(simulation);
  grips_.assign(scene_.instruments.size(), {});
  updateRevision();
}

std::vector<drive::HandCommand> DriveCommands::present(const simulation::Simulation& simulation)
{
  std::vector<drive::HandCommand> commands = simulation::commandsAt(scene_, simulation.time());
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t k = 0; k < commands.size(); ++k)
    if (const drive::HandControl* control = hands_->control(k))
    {
      commands[k].insertion = control->setpoint().motion.insertion;
      commands[k].rotation = control->setpoint().motion.rotation;
      commands[k].pressure = control->setpoint().pressure.value_or(commands[k].pressure);
    }
  return commands;
}

void DriveCommands::playFrom(double time)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (player_)
    player_->startFrom(time);
}

void DriveCommands::archive(Archive& archive)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  hands_->archive(archive);
  updateRevision();
}

/** Gives the commands of the file that are due. */
void DriveCommands::playFile(double time)
{
  const std::size_t before = player_->refusals().size();
  player_->play(time, *hands_);
  for (std::size_t n = before; n < player_->refusals().size(); ++n)
    ROS_WARN("%s", player_->refusals()[n].c_str());
}

void DriveCommands::updateRevision()
{
  std::uint64_t revision = 0;
  for (std::size_t k = 0; k < subscribers_.size(); ++k)
    if (const drive::HandControl* control = hands_->control(k))
      revision += control->state().revision + grips_[k].changes();
  revision_ = revision;
}

const std::vector<drive::HandCommand>& DriveCommands::next(const simulation::Simulation& simulation,
                                                           const std::vector<drive::HandCommand>* scripted,
                                                           const robot::CommandFaults& faults)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (player_)
    playFile(simulation.time());
  const std::vector<drive::HandCommand>& commands = hands_->next(simulation, scripted, &faults);
  watchGrips(simulation);
  updateRevision();
  return commands;
}

/** Follows the grip of every hand that clients drive. */
void DriveCommands::watchGrips(const simulation::Simulation& simulation)
{
  for (std::size_t k = 0; k < grips_.size(); ++k)
  {
    if (hands_->control(k) == nullptr)
      continue;
    const simulation::HandState hand = simulation.hand(static_cast<int>(k));
    const drive::HandMotion reached = simulation.reached(static_cast<int>(k));
    const scene::DriveScene& drive = scene_.instruments[k].drive;
    grips_[k].addStep({reached.insertion - hand.insertion, reached.rotation - hand.rotation},
                      {hand.force / drive.force_limit, hand.torque / drive.torque_limit}, scene_.solver.time_step,
                      hands_->control(k)->isStopped());
  }
}

std::vector<drive::ControlState> DriveCommands::states()
{
  std::vector<drive::ControlState> states(subscribers_.size());
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t k = 0; k < states.size(); ++k)
    if (const drive::HandControl* control = hands_->control(k))
    {
      states[k] = control->state();
      if (states[k].reason.empty())
        states[k].reason = grips_[k].warning();
    }
  return states;
}

void DriveCommands::goals(const std::vector<drive::HandCommand>& used, std::vector<drive::HandCommand>& goals)
{
  goals = used;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t k = 0; k < goals.size(); ++k)
    if (const drive::HandControl* control = hands_->control(k))
    {
      goals[k].insertion = control->goal().insertion;
      goals[k].rotation = control->goal().rotation;
    }
}

std::vector<CommandReport> DriveCommands::reports()
{
  std::vector<CommandReport> reports;
  for (std::size_t k = 0; k < subscribers_.size(); ++k)
  {
    if (subscribers_[k].empty())
      continue;
    CommandReport report;
    const std::string topic = subscribers_[k].front().getTopic();
    report.instrument = topic.substr(0, topic.rfind('/'));
    // The last subscriber is that of state commands.
    report.has_publisher = std::any_of(subscribers_[k].begin(), subscribers_[k].end() - 1,
                                       [](const ros::Subscriber& commands) { return commands.getNumPublishers() > 0; });
    const std::lock_guard<std::mutex> lock(mutex_);
    const drive::HandControl& control = *hands_->control(k);
    fill(report, control.arbiter());
    report.rejected = control.rejected();
    report.warning = grips_[k].warning();
    reports.push_back(report);
  }
  return reports;
}

}  // namespace endovascular_sim::nodes
