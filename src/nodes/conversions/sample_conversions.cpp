#include "nodes/conversions/sample_conversions.h"

#include <string>

#include "common/error.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

void toMessage(const results::Sample& sample, SessionSample& message)
{
  message.time = sample.observation.time;
  const std::size_t size = sample.observation.instruments.size();
  for (std::vector<double>* list : {&message.insertion, &message.rotation, &message.tip_rotation, &message.hand_force,
                                    &message.hand_torque, &message.pressure})
    list->resize(size);
  message.tip.resize(size);
  for (std::size_t k = 0; k < size; ++k)
  {
    const procedure::InstrumentView& view = sample.observation.instruments[k];
    message.insertion[k] = view.hand.insertion;
    message.rotation[k] = view.hand.rotation;
    message.tip_rotation[k] = view.tip_rotation;
    message.hand_force[k] = view.hand.force;
    message.hand_torque[k] = view.hand.torque;
    message.pressure[k] = view.hand.pressure;
    message.tip[k] = toPoint(view.tip);
  }
  message.wall_force = sample.wall.sum;
  message.largest_contact = sample.wall.largest;
  message.tip_force = sample.wall.at_tip;
  message.peak_hand_force = sample.peaks.hand_force;
  message.peak_hand_torque = sample.peaks.hand_torque;
  message.peak_wall_force = sample.peaks.wall.sum;
  message.peak_contact = sample.peaks.wall.largest;
  message.peak_tip_force = sample.peaks.wall.at_tip;
  message.rejected_steps = sample.faults.rejected_steps;
  message.stale_steps = sample.faults.stale_steps;
}

results::Sample fromMessage(const SessionSample& message, std::size_t instruments)
{
  for (const std::size_t size : {message.insertion.size(), message.rotation.size(), message.tip_rotation.size(),
                                 message.hand_force.size(), message.hand_torque.size(), message.pressure.size(),
                                 message.tip.size(), message.peak_hand_force.size(), message.peak_hand_torque.size()})
    if (size != instruments)
      throw InputError(
          names::kSessionSample, "insertion to peak_hand_torque",
          "must have one element for each of the " + std::to_string(instruments) + " instruments of the scene");
  results::Sample sample;
  sample.observation.time = message.time;
  for (std::size_t k = 0; k < instruments; ++k)
  {
    procedure::InstrumentView view;
    view.hand = {message.insertion[k], message.rotation[k], message.hand_force[k], message.hand_torque[k],
                 message.pressure[k]};
    view.tip = fromMessage(message.tip[k]);
    view.tip_rotation = message.tip_rotation[k];
    sample.observation.instruments.push_back(view);
  }
  procedure::markCovered(sample.observation);
  sample.wall = {message.wall_force, message.largest_contact, message.tip_force};
  sample.peaks = {message.peak_hand_force,
                  message.peak_hand_torque,
                  {message.peak_wall_force, message.peak_contact, message.peak_tip_force}};
  sample.faults = {message.rejected_steps, message.stale_steps};
  return sample;
}

}  // namespace endovascular_sim::nodes
