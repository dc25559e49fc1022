#include "nodes/session/offline_bag.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <sensor_msgs/FluidPressure.h>

#include "common/error.h"
#include "contact/contract/contact_set.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/flow_conversions.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/conversions/rod_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/recording.h"
#include "nodes/session/session_identity.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
OfflineBag::OfflineBag(const std::string& file, const session::Session& session, const std::string& subject)
  : bag_(file),
    pose_(session.scene().record.pose_rate),
    heart_(kHeartRate),
    flow_(kFlowRate),
    has_balloon_(simulation::hasBalloon(session.scene()))
{
  SessionInfo info = infoOf(session.scene(), subject);
  info.mesh_hash = session.world().meshHash();
  bag_.writeLatched(std::string("/") + names::kSessionInfo, info, now_);
  if (session.world().vessel() != nullptr)
    addVessel(session.world());
  if (session.simulation().blood() != nullptr)
    addNetwork(session);
  if (session.simulation().motion() != nullptr)
    addControls(session.motionControls());
  if (session.simulation().contrast() != nullptr)
    addCells(session.world());
}

/** Writes a message with the present simulated time. */
template <typename Message>
void OfflineBag::write(const char* topic, Message message)
{
  message.header.stamp = now_;
  bag_.write(std::string("/") + topic, now_, boost::make_shared<Message>(std::move(message)));
}

void OfflineBag::addVessel(const session::World& world)
{
  VesselMesh mesh;
  toMessage(world.vessel()->mesh, mesh);
  mesh.header.frame_id = names::kPatientFrame;
  bag_.writeLatched(std::string("/") + names::kVesselMesh, mesh, now_);
  VesselCentreline centreline;
  toMessage(world.vessel()->centreline, centreline);
  toMessage(world.vessel()->lesions, centreline);
  centreline.header.frame_id = names::kPatientFrame;
  centreline.content_hash = mesh.content_hash;
  bag_.writeLatched(std::string("/") + names::kVesselCentreline, centreline, now_);
}

/** Writes the places of the flow's cells, and its controls at the beginning. */
void OfflineBag::addNetwork(const session::Session& session)
{
  lines_ = pressureLineFrames(session.scene());
  flow_time_step_ = session.scene().flow->time_step;
  FlowNetwork network;
  const vessel::Vessel& vessel = *session.world().vessel();
  toMessage(session.simulation().blood()->places().tree(), vessel.centreline, vessel.lesions, network);
  network.header.frame_id = names::kPatientFrame;
  network.content_hash = session.world().meshHash();
  network.lines = lines_;
  bag_.writeLatched(std::string("/") + names::kFlowNetwork, network, now_);
  addControls(session.flowControls());
}

/** Writes the controls of the flow if they have changed. */
void OfflineBag::addControls(const flow::FlowControls& controls)
{
  if (controls_ == controls)
    return;
  controls_ = controls;
  HemodynamicControls message;
  toMessage(controls, message);
  message.step = steps_;
  write(names::kHemodynamicControls, std::move(message));
}

/** Writes the controls of the motion if they have changed. */
void OfflineBag::addControls(const motion::MotionControls& controls)
{
  if (motion_controls_ == controls)
    return;
  motion_controls_ = controls;
  MotionControls message;
  toMessage(controls, message);
  message.step = steps_;
  write(names::kMotionControls, std::move(message));
}

/** Writes the places of the cells of contrast medium. */
void OfflineBag::addCells(const session::World& world)
{
  ContrastCells cells;
  toMessage(world.contrastVessel().cells, world.lumen()->volumes, world.vessel()->centreline, cells);
  cells.header.frame_id = names::kPatientFrame;
  cells.content_hash = world.meshHash();
  bag_.writeLatched(std::string("/") + names::kContrastCells, cells, now_);
}

/** Writes the injections that are not written yet. */
void OfflineBag::addInjections(const simulation::ContrastInjections& injections)
{
  const std::vector<simulation::ContrastInput>& inputs = injections.inputs();
  if (inputs.empty())
    return;
  if (inputs.back().step != injection_step_)
    injections_ = 0;
  injection_step_ = inputs.back().step;
  for (; injections_ < inputs.size(); ++injections_)
  {
    ContrastInjection message;
    toMessage(inputs[injections_], message);
    write(names::kContrastInjection, std::move(message));
  }
}

/** Writes the step of the flow that acts since the last step of the simulation, if it is another one than before. */
void OfflineBag::addBlood(const simulation::BloodCoupling& blood)
{
  if (std::exchange(flow_steps_, blood.steps()) == blood.steps() || blood.field() == nullptr)
    return;
  const flow::FlowField& field = *blood.field();
  for (std::size_t k = 0; k < lines_.size(); ++k)
  {
    sensor_msgs::FluidPressure pressure;
    pressure.header.frame_id = lines_[k];
    pressure.fluid_pressure = field.readings.at(k);
    write(names::kTipPressure, std::move(pressure));
  }
  const std::uint64_t step = blood.steps() - 2;  // the one before that which has begun
  const double time = static_cast<double>(step) * flow_time_step_;
  if (heart_.passes(time))
  {
    HeartPhase phase;
    phase.step = step;
    phase.time = time;
    phase.header.frame_id = names::kPatientFrame;
    toMessage(field, blood.controls(), phase);
    write(names::kHeartPhase, std::move(phase));
  }
  if (!flow_.passes(time))
    return;
  BloodFlow flow;
  flow.step = step;
  flow.time = time;
  flow.header.frame_id = names::kPatientFrame;
  toMessage(field, flow);
  write(names::kBloodFlow, std::move(flow));
}

void OfflineBag::addStep(const session::Session& session)
{
  if (session.simulation().blood() != nullptr)
    addControls(session.flowControls());
  if (session.simulation().motion() != nullptr)
    addControls(session.motionControls());
  const simulation::Simulation& simulation = session.simulation();
  if (simulation.contrast() != nullptr)
    addInjections(*simulation.contrast());
  steps_ = simulation.steps();
  now_ = ros::Time(simulation.time());
  DriveApplied applied;
  applied.step = steps_ - 1;
  for (const drive::HandCommand& command : session.executedCommands())
  {
    applied.insertion.push_back(command.insertion);
    applied.rotation.push_back(command.rotation);
    applied.pressure.push_back(command.pressure);
  }
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    applied.hand_force.push_back(simulation.hand(k).force);
    applied.hand_torque.push_back(simulation.hand(k).torque);
  }
  applied.first_stale_pass = contact::kNoStalePass;
  applied.state_hash = simulation.stateHash();
  write(names::kDriveApplied, std::move(applied));
  if (simulation.blood() != nullptr)
    addBlood(*simulation.blood());
  if (session.scriptedOperator() != nullptr)
    addProcedure(*session.scriptedOperator(), steps_ - 1);
  const bool is_last = session.isOver();
  if (pose_.passes(simulation.time()) || is_last)
    addState(simulation);
  else if (simulation.events().size() != events_)
    addState(simulation);
  events_ = simulation.events().size();
}

void OfflineBag::addProcedure(const procedure::Operator& scripted, std::uint64_t step)
{
  for (ProcedureStep& message : procedure_.changes(scripted, step, false))
    write(names::kProcedureStep, std::move(message));
}

void OfflineBag::addMotion(const simulation::Simulation& simulation)
{
  MotionState motion;
  toMessage(simulation.motion()->patient(), motion);
  motion.step = simulation.steps() - 1;
  motion.time = simulation.time();
  motion.header.frame_id = names::kPatientFrame;
  write(names::kMotionState, std::move(motion));
}

void OfflineBag::addContrast(const simulation::Simulation& simulation)
{
  ContrastState contrast;
  toMessage(simulation, contrast);
  contrast.header.frame_id = names::kPatientFrame;
  write(names::kContrastState, std::move(contrast));
}

void OfflineBag::addState(const simulation::Simulation& simulation)
{
  if (simulation.motion() != nullptr)
    addMotion(simulation);
  if (simulation.contrast() != nullptr)
    addContrast(simulation);
  RodStateVisual state;
  toMessage(simulation, state);
  state.header.frame_id = names::kPatientFrame;
  write(names::kRodStateVisual, std::move(state));
  if (!has_balloon_)
    return;
  TreatmentVisual treatment;
  treatment.step = simulation.steps() - 1;
  treatment.time = simulation.time();
  toMessage(simulation, treatment);
  treatment.header.frame_id = names::kPatientFrame;
  write(names::kTreatmentVisual, std::move(treatment));
}

void OfflineBag::close()
{
  SessionEnd end;
  end.header.stamp = now_;
  end.steps = steps_;
  end.step_limit = std::numeric_limits<std::uint64_t>::max();
  bag_.writeLatched(std::string("/") + names::kSessionEnd, end, now_);
  bag_.close();
  if (!bag_.error().empty())
    throw InputError(bag_.file(), "", bag_.error());
}

}  // namespace endovascular_sim::nodes
