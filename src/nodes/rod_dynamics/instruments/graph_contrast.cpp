#include "nodes/rod_dynamics/instruments/graph_contrast.h"

#include <vector>

#include "common/error.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kQueue = 100;  ///< inputs that wait for a slow recorder

}  // namespace

GraphContrast::GraphContrast(ros::NodeHandle& node, const session::Session& session)
  : cells_(node.advertise<ContrastCells>(names::kContrastCells, 1, true)),
    injection_(node.advertise<ContrastInjection>(names::kContrastInjection, kQueue, true))
{
  const session::World& world = session.world();
  ContrastCells message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = names::kPatientFrame;
  message.content_hash = world.meshHash();
  toMessage(world.contrastVessel().cells, world.lumen()->volumes, world.vessel()->centreline, message);
  cells_.publish(message);
}

void GraphContrast::beginRun(const session::Session& session, std::uint32_t run)
{
  message_.run = run;
  // Those of the state from which the run continues are part of it.
  const std::vector<simulation::ContrastInput>& inputs = session.simulation().contrast()->inputs();
  published_ = inputs.size();
  step_ = inputs.empty() ? 0 : inputs.back().step;
}

std::string GraphContrast::inject(session::Session& session, const InjectContrast::Request& request)
{
  simulation::ContrastInput input;
  input.injection = injectionOf(request, *session.scene().contrast);
  input.refill = request.refill != 0;
  if (input.injection.volume == 0.0)
  {
    if (input.refill)
      session.refillSyringe();
    else
      session.stopInjection();
    return textOf(input);
  }
  if (const std::string refusal = session.refusalOf(input.injection, input.refill); !refusal.empty())
    throw InputError(names::kInjectContrast, "", refusal);
  session.inject(input.injection, input.refill);
  return textOf(input);
}

void GraphContrast::publishInputs(const session::Session& session, ros::Time stamp)
{
  const std::vector<simulation::ContrastInput>& inputs = session.simulation().contrast()->inputs();
  if (inputs.empty())
    return;
  if (inputs.back().step != step_)
    published_ = 0;
  step_ = inputs.back().step;
  for (; published_ < inputs.size(); ++published_)
  {
    message_.header.stamp = stamp;
    toMessage(inputs[published_], message_);
    injection_.publish(message_);
  }
}

}  // namespace endovascular_sim::nodes
