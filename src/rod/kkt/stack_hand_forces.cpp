#include <algorithm>
#include <cmath>

#include "rod/boundary/boundary_conditions.h"
#include "rod/kkt/stack_layers.h"
#include "rod/model/node_curvature.h"

// Energy of a stack, and what each hand feels: the energy's change with its layer's insertion, the wall's friction,
// that between layers.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kOffsetTime = 0.1;  // s in which an offset of a hand's force fades to 1/e
constexpr double kNoOffset = 1e-9;   // N
constexpr double kBlur = 3e-3;       // m to both sides of a place over which the layers' ends are not sharp

}  // namespace

/** By how much a layer's insertion widens the stack at a node [1]. */
double StackStepper::widening(int k, int node, const LayerProfile::Slope& slope) const
{
  double inside = 0.0;
  for (int m = 0; m < k; ++m)
    inside += stack_.profile(m).cover(node) * (stack_.profile(m).rod().radius[node] - inside);
  double seen = 1.0;
  for (int m = k + 1; m < stack_.count(); ++m)
    seen *= 1.0 - stack_.profile(m).cover(node);
  return seen *
         (slope.cover * (stack_.profile(k).rod().radius[node] - inside) + stack_.profile(k).cover(node) * slope.radius);
}

/** Of weight and buoyancy, and of the wall's push where the layer's edge lies between it and the layers inside [N]. */
double StackStepper::gradientAtNode(int k, int node, const State& state) const
{
  const LayerProfile::Slope slope = stack_.profile(k).slope(node);
  const double wider = widening(k, node, slope);
  const double displaced =
      environment().fluid_density * 2.0 * M_PI * stack_rod().radius[node] * wider * stack_rod().cell_length[node];
  const double height = -environment().gravity.dot(state.position[node] - boundary().origin);
  return (slope.mass - displaced) * height + state.wall_force[node].norm() * wider;
}

/** What one side of a joint of a layer's sections is made of, all layers together. */
class StackStepper::Side
{
public:
  /** @param rest curvature in space [1/m] */
  void add(double bending_stiffness, const Eigen::Vector3d& rest)
  {
    stiffness_ += bending_stiffness;
    rest_moment_ += bending_stiffness * rest;
    straight_energy_ += 0.5 * bending_stiffness * rest.squaredNorm();
  }

  /** Energy of bending less the work of a moment on it, per length [N]. */
  double energyUnder(const Eigen::Vector3d& moment) const
  {
    return stiffness_ > 0.0 ? straight_energy_ - 0.5 * (moment + rest_moment_).squaredNorm() / stiffness_ : 0.0;
  }

  /** Energy per length where it is held straight [N]. */
  double straightEnergy() const { return straight_energy_; }

private:
  double stiffness_ = 0.0;
  Eigen::Vector3d rest_moment_ = Eigen::Vector3d::Zero();
  double straight_energy_ = 0.0;
};

/** The node before a place and the share of the way to the next one. */
StackStepper::Place StackStepper::placeAt(double place) const
{
  const std::vector<double>& position = stack_rod().position;
  const auto after = std::upper_bound(position.begin(), position.end() - 1, place);
  const int node = std::max(0, static_cast<int>(after - position.begin()) - 1);
  return {node, std::max(0.0, std::min(1.0, (place - position[node]) / stack_rod().rest_length[node]))};
}

/** Bending moment of all layers at a node [N·m]. */
Eigen::Vector3d StackStepper::momentAt(int node, const State& state) const
{
  if (node <= state.first_node || node + 1 >= stack_rod().nodes())
    return Eigen::Vector3d::Zero();
  Eigen::Vector3d strain = binormalAt(stack_rod(), state, node).value - state.curvature_offset[node];
  if (node >= first_curved_)
    strain -= rest_binormal_[node];
  return (stack_rod().bending_stiffness[node] / stack_rod().cell_length[node]) * strain;
}

/** A rest curvature of a layer in space [1/m]. */
Eigen::Vector3d StackStepper::restAt(int k, const Eigen::Vector2d& curvature, const Place& at, const State& state) const
{
  const int first = twist_[k].firstCurved();
  const int last = stack_.profile(k).rod().nodes() - 2;
  if (curvature.isZero(0.0) || !twisted_[k] || first > last)
    return Eigen::Vector3d::Zero();
  const auto rest = [&](int node)
  { return twist_[k].binormalOf(curvature, std::max(first, std::min(last, node)), state.layers[k].twist_angle); };
  return (1.0 - at.share) * rest(at.node) + at.share * rest(at.node + 1);
}

/** The other layers' sections at a place.
 *  @param at where their angles count */
StackStepper::Side StackStepper::othersAt(int k, double place, const Place& at, const State& state) const
{
  Side side;
  for (int m = 0; m < stack_.count(); ++m)
  {
    const LayerProfile& profile = stack_.profile(m);
    std::size_t section = 0;
    while (section < profile.wire().sections.size() && profile.sectionEnd(section) < place)
      ++section;
    if (m == k || section == profile.wire().sections.size())
      continue;
    const Section& part = profile.wire().sections[section];
    side.add(part.bending_stiffness, restAt(m, part.rest_curvature, at, state));
  }
  return side;
}

/** First end of another layer's section between two places [m]; @p end without. */
double StackStepper::nextEnd(int k, double begin, double end) const
{
  for (int m = 0; m < stack_.count(); ++m)
    for (std::size_t section = 0; m != k && section < stack_.profile(m).wire().sections.size(); ++section)
      if (stack_.profile(m).sectionEnd(section) > begin)
        end = std::min(end, stack_.profile(m).sectionEnd(section));
  return end;
}

/** What a joint between two sections of a layer, or its tip, takes to advance by a unit of length [N]: the section
 *  before it comes to where the one after it was. The other layers are those about the place, on average.
 *  @param after null at the tip */
double StackStepper::jointForce(int k, double place, const Section& before, const Section* after,
                                const State& state) const
{
  const Place at = placeAt(place);
  const Eigen::Vector3d moment = (1.0 - at.share) * momentAt(at.node, state) + at.share * momentAt(at.node + 1, state);
  const Eigen::Vector3d rest_before = restAt(k, before.rest_curvature, at, state);
  const Eigen::Vector3d rest_after =
      after != nullptr ? restAt(k, after->rest_curvature, at, state) : Eigen::Vector3d::Zero();
  double bent = 1.0;  // else held straight by the introducer
  if (boundary().introducer)
  {
    const double straight = stack_rod().length() - state.inserted_length - boundary().guide_length;
    bent = std::max(0.0, std::min(1.0, (place - straight) / kBlur));
  }
  double force = 0.0;
  double end = 0.0;
  for (double begin = place - kBlur; begin < place + kBlur; begin = end)
  {
    end = nextEnd(k, begin, place + kBlur);
    Side now = othersAt(k, 0.5 * (begin + end), at, state);
    Side then = now;
    then.add(before.bending_stiffness, rest_before);
    if (after != nullptr)
      now.add(after->bending_stiffness, rest_after);
    force += (end - begin) / (2.0 * kBlur) *
             (bent * (then.energyUnder(moment) - now.energyUnder(moment)) +
              (1.0 - bent) * (then.straightEnergy() - now.straightEnergy()));
  }
  if (after == nullptr || !twisted_[k] || at.node <= state.first_node || at.node + 2 >= stack_.profile(k).rod().nodes())
    return force;
  const double torque = (1.0 - at.share) * twist_[k].torque(at.node) + at.share * twist_[k].torque(at.node + 1);
  return force - 0.5 * torque * torque * (1.0 / before.torsional_stiffness - 1.0 / after->torsional_stiffness);
}

/** ∂E/∂ℓ of a layer at fixed nodes and angles, on average over the nodes that its joints pass. */
double StackStepper::gradientByInsertion(int k, const State& state) const
{
  const LayerProfile& profile = stack_.profile(k);
  const std::vector<Section>& sections = profile.wire().sections;
  double force = 0.0;
  for (std::size_t m = 0; m < sections.size(); ++m)
    force +=
        jointForce(k, profile.sectionEnd(m), sections[m], m + 1 < sections.size() ? &sections[m + 1] : nullptr, state);
  for (const int i : profile.slidingNodes())
    if (i > state.first_node)
      force += gradientAtNode(k, i, state);
  return force;
}

/** Force of the wall's friction on the hand of a layer where that is the outermost one [N]. */
double StackStepper::wallDrag(int k, const State& state) const
{
  double force = 0.0;
  for (int i = state.first_node; i < stack_rod().nodes(); ++i)
    if (!state.wall_force[i].isZero(0.0) && stack_.surfaceLayer(i) == k)
      force -= frictionForce(state, i, settings().friction_slip).dot(tangent(state, i));
  return force;
}

/** What inertia, damping and the fluid hold against a layer's motion along itself [N]. */
double StackStepper::motionDrag(int k, const State& state, double dt) const
{
  if (moved_[k] == 0.0 && gained_[k] == 0.0)
    return 0.0;
  const double speed = moved_[k] / dt;
  double force = 0.0;
  for (int i = state.first_node; i < stack_rod().nodes(); ++i)
  {
    force += stack_.profile(k).rod().mass[i] * (gained_[k] / (dt * dt) + environment().damping * speed);
    if (stack_.surfaceLayer(i) != k)
      continue;
    Eigen::Vector3d velocity = state.velocity[i];
    if (slides_)
      velocity += surface_slide_[i] / dt;
    force += dragCoefficient(i, velocity.norm(), state) * speed;
  }
  return force;
}

/** Hand forces of a state whose twist has been relaxed; that of the reference is what the others leave of the whole. */
void StackStepper::setHandForces(State& state, double dt)
{
  for (int k = 0; k < stack_.count(); ++k)
  {
    LayerState& layer = state.layers[k];
    layer.hand_force = layer.force_offset;
    if (k != state.reference)
      layer.hand_force += gradientByInsertion(k, state) + wallDrag(k, state) + motionDrag(k, state, dt);
  }
  for (int k = 0; k < stack_.count(); ++k)
  {
    const int outer = nextOuter(k, state);
    if (outer < 0)
      continue;
    const double force = axialFriction(k, outer, state);
    state.layers[k].hand_force += force;
    state.layers[outer].hand_force -= force;
  }
  double others = 0.0;
  for (int k = 0; k < stack_.count(); ++k)
    others += k == state.reference ? 0.0 : state.layers[k].hand_force;
  state.layers[state.reference].hand_force = state.hand_force - others;
}

void StackStepper::complete(State& state, double dt)
{
  if (stack_.count() == 1)
  {
    state.layers[0].hand_force = state.hand_force;
    return;
  }
  for (int k = 0; k < stack_.count(); ++k)
    state.layers[k].speed = moved_[k] / dt;
  const double left = std::exp(-dt / kOffsetTime);
  for (LayerState& layer : state.layers)
    layer.force_offset = std::abs(layer.force_offset) < kNoOffset ? 0.0 : left * layer.force_offset;
  setLoads(state);
  setBodyShares(state);
  settleTurns(state);
  setHandForces(state, dt);
}

std::vector<double> StackStepper::insertionGradient(State state, const StepInput& input)
{
  PhaseTimer unused;
  useTimer(unused);
  place(state);
  relaxTwist(state, input, {});
  std::vector<double> gradient(state.layers.size(), 0.0);
  for (int k = 0; k < stack_.count(); ++k)
    if (k != state.reference)
      gradient[k] = gradientByInsertion(k, state);
  return gradient;
}

Energy StackStepper::energy(const State& state)
{
  State relaxed = state;
  PhaseTimer unused;
  useTimer(unused);
  place(state);
  relaxFromHere(relaxed);
  Energy sum;
  for (int k = 0; k < stack_.count(); ++k)
  {
    const Discretisation& layer = stack_.profile(k).rod();
    if (layer.nodes() < state.first_node + 3)
      continue;
    const Energy energy = elasticEnergy(layer, state, twisted_[k] ? &twist_[k] : nullptr);
    sum.bending += energy.bending;
    sum.twist += energy.twist;
    sum.stretch += energy.stretch;
  }
  return sum;
}

double StackStepper::handWork(const State& before, const State& after) const
{
  double work = 0.0;
  for (std::size_t k = 0; k < after.layers.size(); ++k)
  {
    const LayerState& layer = after.layers[k];
    work += std::abs(layer.hand_force * (layer.inserted_length - before.layers[k].inserted_length)) +
            std::abs(layer.hand_torque * (layer.rotation - before.layers[k].rotation));
  }
  return work;
}

}  // namespace endovascular_sim::rod
