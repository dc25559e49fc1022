#include "benchmark/sleeve/sleeve_runs.h"

#include <algorithm>
#include <stdexcept>

#include "rod/kkt/kkt_stepper.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kDistance = 0.2;           // L, between sleeve and pin [m]
constexpr double kBendingStiffness = 1e-3;  // EI [N·m²]
constexpr double kLength = 0.8;             // of the wire [m]
constexpr double kDisturbed = 0.7;          // arc length of the lateral load that selects the side of buckling [m]
constexpr double kDisturbance = 1e-4;       // that load [N]
constexpr double kTurn = 0.01;              // length over L beyond the last one, at which the motion reverses
constexpr double kForceUnit = kBendingStiffness / (kDistance * kDistance);

class SleeveRun
{
public:
  explicit SleeveRun(const SleeveMotion& motion)
    : motion_(motion),
      stepper_(discretisation(motion.nodes), boundary(motion), environment(), rod::StepperSettings()),
      state_(stepper_.initialState(kDistance, 0.0))
  {
    input_.inserted_length = kDistance;
    input_.forces.push_back(
        {static_cast<int>(kDisturbed / kLength * (motion.nodes - 1)), Eigen::Vector3d(0.0, kDisturbance, 0.0)});
  }

  /** Moves at constant speed to the first step at or beyond a length. */
  SleeveForce moveTo(double length)
  {
    const double target = length * kDistance;
    const double way = target > input_.inserted_length ? 1.0 : -1.0;
    while (way * (target - input_.inserted_length) > 0.0)
    {
      input_.inserted_length += way * motion_.speed * motion_.time_step;
      std::uint32_t pass = 0;
      if (!stepper_.step(state_, input_, motion_.time_step, pass, nullptr, timer_).solved)
        throw std::runtime_error("sleeve: a step was rejected");
      ++input_.step;
    }
    const rod::HandForceParts& parts = state_.hand_parts;
    return {input_.inserted_length / kDistance, (state_.hand_force - parts.drag - parts.inertia) / kForceUnit,
            parts.configurational / kForceUnit, stepper_.energy(state_).bending / (kForceUnit * kDistance)};
  }

private:
  static rod::Discretisation discretisation(int nodes)
  {
    rod::Section section;
    section.length = kLength;
    section.radius = 4e-4;
    section.density = 6450.0;
    section.bending_stiffness = kBendingStiffness;
    section.torsional_stiffness = kBendingStiffness / 1.3;
    rod::Wire wire;
    wire.sections.push_back(section);
    return rod::discretiseUniformly(wire, nodes);
  }

  static rod::Boundary boundary(const SleeveMotion& motion)
  {
    rod::Boundary boundary;
    boundary.guide_length = motion.guide_length;
    boundary.distal = rod::EndHold::kPinned;
    return boundary;
  }

  static rod::Environment environment()
  {
    rod::Environment environment;
    environment.damping = 30.0;
    return environment;
  }

  const SleeveMotion motion_;
  rod::KktStepper stepper_;
  rod::State state_;
  rod::StepInput input_;
  PhaseTimer timer_;
};

}  // namespace

SleeveCurve runSleeve(const SleeveMotion& motion)
{
  SleeveRun run(motion);
  SleeveCurve curve;
  for (const double length : motion.lengths)
    curve.in.push_back(run.moveTo(length));
  run.moveTo(motion.lengths.back() + kTurn);
  for (auto length = motion.lengths.rbegin(); length != motion.lengths.rend(); ++length)
    curve.out.push_back(run.moveTo(*length));
  std::reverse(curve.out.begin(), curve.out.end());
  return curve;
}

}  // namespace endovascular_sim::benchmark
