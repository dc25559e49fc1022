#pragma once

#include <functional>
#include <string>
#include <vector>

#include "procedure/observation.h"
#include "procedure/operator.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::procedure
{

/** Trunk of 200 mm along z with a side branch at 100 mm and a goal branch at 150 mm, each 60 mm long. */
inline vessel::CentrelineTree forkedTree()
{
  vessel::CentrelineTree tree;
  const auto add = [&tree](const std::string& name, int parent, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           double radius)
  {
    vessel::CentrelineBranch branch;
    branch.name = name;
    branch.parent = parent;
    for (int k = 0; k <= 40; ++k)
    {
      branch.points.push_back(from + k / 40.0 * (to - from));
      branch.radii.push_back(radius);
    }
    tree.branches.push_back(branch);
  };
  add("trunk", -1, {0, 0, 0}, {0, 0, 0.2}, 0.01);
  add("side", 0, {0, 0, 0.1}, {0.06, 0, 0.1}, 0.003);
  add("goal", 0, {0, 0, 0.15}, {-0.06, 0, 0.15}, 0.003);
  return tree;
}

/** Scene with a wire and a catheter, both driven by the operator. @param steps YAML of the procedure's steps */
inline scene::Scene sceneWith(const std::string& steps, const std::string& hand = "{}")
{
  return scene::parseScene(
      "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.3}]}}\n"
      "instruments:\n"
      "  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: procedure}}\n"
      "  - {instrument: {use: catheter_5f_jl4, name: catheter}, drive: {source: procedure}}\n"
      "procedure:\n  hand: " +
          hand + "\n  steps:\n" + steps,
      "test scene");
}

/** Kinematic world: instruments follow their commands immediately, and @p tip gives the position of their tips. */
class PlainWorld
{
public:
  using Tip = std::function<Eigen::Vector3d(double insertion, double rotation)>;

  explicit PlainWorld(
      const scene::Scene& scene,
      Tip tip = [](double insertion, double /*rotation*/) { return Eigen::Vector3d(0.0, 0.0, insertion); })
    : scripted_operator(scene, forkedTree(), {0, 0, 0.001}), tip_(std::move(tip)), hands_(scene.instruments.size())
  {
  }

  void run(double seconds)
  {
    for (const double end = time + seconds; time < end - 1e-9; ++steps_)
    {
      if (scripted_operator.observesBefore(steps_))
        scripted_operator.observe(observation());
      time = static_cast<double>(steps_ + 1) * 1e-3;
      const std::vector<drive::HandCommand> commands = scripted_operator.advance(time);
      for (std::size_t k = 0; k < hands_.size(); ++k)
      {
        hands_[k].insertion = commands[k].insertion;
        hands_[k].rotation = commands[k].rotation;
        hands_[k].pressure = commands[k].pressure;
      }
      history.push_back(commands);
    }
  }

  Observation observation() const
  {
    Observation observation;
    observation.time = time;
    for (const simulation::HandState& hand : hands_)
    {
      InstrumentView view;
      view.hand = hand;
      view.hand.force = force;
      view.outside = hand.insertion <= -0.02;
      view.tip = tip_(hand.insertion, hand.rotation);
      view.branch_position = hand.insertion > 0.0 ? scripted_operator.locator().at(view.tip) : BranchPosition();
      observation.instruments.push_back(view);
    }
    if (disturbance)
      disturbance(observation);
    return observation;
  }

  Operator scripted_operator;
  double time = 0.0;
  double force = 0.0;                                         ///< force at each handle [N]
  std::function<void(Observation& observation)> disturbance;  ///< modifies each observation
  std::vector<std::vector<drive::HandCommand>> history;
  const simulation::HandState& hand(int k) const { return hands_[static_cast<std::size_t>(k)]; }

private:
  Tip tip_;
  std::uint64_t steps_ = 0;
  std::vector<simulation::HandState> hands_;
};

}  // namespace endovascular_sim::procedure
