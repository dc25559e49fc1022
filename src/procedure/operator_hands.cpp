#include "procedure/operator_hands.h"

#include <algorithm>

namespace endovascular_sim::procedure
{
namespace
{

/** @return @p from moved towards @p to by at most @p limit */
double towards(double from, double to, double limit)
{
  return from + std::clamp(to - from, -limit, limit);
}

}  // namespace

OperatorHands::OperatorHands(const scene::Scene& scene)
{
  for (const scene::DrivenInstrument& driven : scene.instruments)
  {
    OperatorHand hand;
    hand.insertion = driven.drive.insertionAt(0.0);
    hand.rotation = driven.drive.rotationAt(0.0);
    hand.scripted = driven.drive.source == scene::DriveSource::kProcedure;
    hands_.push_back(hand);
  }
  commands_.resize(hands_.size());
}

void OperatorHands::stop()
{
  for (OperatorHand& hand : hands_)
    hand.target_speed = hand.target_turn_speed = 0.0;
}

const std::vector<drive::HandCommand>& OperatorHands::advance(const scene::Scene& scene, double end_time)
{
  const scene::HandScene& limits = scene.procedure->hand;
  const double dt = scene.solver.time_step;
  for (std::size_t k = 0; k < hands_.size(); ++k)
  {
    OperatorHand& hand = hands_[k];
    const scene::DriveScene& drive = scene.instruments[k].drive;
    if (!hand.scripted)
    {
      commands_[k] = {drive.insertionAt(end_time), drive.rotationAt(end_time), drive.pressureAt(end_time)};
      continue;
    }
    hand.speed = towards(hand.speed, hand.target_speed, limits.acceleration * dt);
    hand.turn_speed = towards(hand.turn_speed, hand.target_turn_speed, limits.turn_acceleration * dt);
    hand.insertion += dt * hand.speed;
    hand.rotation += dt * hand.turn_speed;
    commands_[k] = {hand.insertion, hand.rotation, hand.pressure};
  }
  return commands_;
}

void OperatorHands::archive(Archive& archive)
{
  for (OperatorHand& hand : hands_)
    archive(hand);
}

}  // namespace endovascular_sim::procedure
