#include "rod/kkt/insertion_forces.h"

#include <algorithm>
#include <cmath>

#include "rod/model/node_curvature.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kBlur = 3e-3;  // m to both sides of a joint over which the ends of layers are averaged

}  // namespace

/** Change of the stack's radius at a node per insertion of a layer [1]. */
double InsertionForces::widening(int k, int node, const LayerProfile::Slope& slope) const
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

/** Gradient of weight and buoyancy [N]. */
double InsertionForces::gravityAtNode(int k, int node, const State& state) const
{
  const LayerProfile::Slope slope = stack_.profile(k).slope(node);
  const double wider = widening(k, node, slope);
  const double displaced =
      model_.environment.fluid_density * 2.0 * M_PI * model_.rod.radius[node] * wider * model_.rod.cell_length[node];
  const double height = -model_.environment.gravity.dot(state.position[node] - model_.boundary.origin);
  return (slope.mass - displaced) * height;
}

/** Cross-section of the stack on one side of a joint between sections of a layer. */
class InsertionForces::Side
{
public:
  /** @param rest curvature in space [1/m]
   *  @param acting part of it that acts, 0 inside the introducer to 1 beyond the mouth */
  void add(double bending_stiffness, const Eigen::Vector3d& rest, double acting)
  {
    stiffness_ += bending_stiffness;
    rest_moment_ += acting * bending_stiffness * rest;
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

/** Node before an arc length, and the parameter on its edge. */
InsertionForces::Location InsertionForces::locate(double arc_length) const
{
  const std::vector<double>& position = model_.rod.position;
  const auto after = std::upper_bound(position.begin(), position.end() - 1, arc_length);
  const int node = std::max(0, static_cast<int>(after - position.begin()) - 1);
  return {node, std::max(0.0, std::min(1.0, (arc_length - position[node]) / model_.rod.rest_length[node]))};
}

/** Bending moment of all layers at a node [N·m]. */
Eigen::Vector3d InsertionForces::momentAt(int node, const State& state) const
{
  if (node <= state.first_node || node + 1 >= model_.rod.nodes())
    return Eigen::Vector3d::Zero();
  Eigen::Vector3d strain = binormalAt(model_.rod, state, node).value - state.curvature_offset[node];
  if (node >= twists_.firstCurved())
    strain -= twists_.restBinormal(node);
  return (model_.rod.bending_stiffness[node] / model_.rod.cell_length[node]) * strain;
}

/** Rest curvature of a layer in space [1/m]. */
Eigen::Vector3d InsertionForces::restAt(int k, const Eigen::Vector2d& curvature, const Location& at,
                                        const State& state) const
{
  const int first = twists_.of(k).firstCurved();
  const int last = stack_.profile(k).rod().nodes() - 2;
  if (curvature.isZero(0.0) || !twists_.isActive(k) || first > last)
    return Eigen::Vector3d::Zero();
  const auto rest = [&](int node)
  { return twists_.of(k).binormalOf(curvature, std::max(first, std::min(last, node)), state.layers[k].twist_angle); };
  return (1.0 - at.parameter) * rest(at.node) + at.parameter * rest(at.node + 1);
}

/** Part of the rest curvature that acts at a location. */
double InsertionForces::restShare(const Location& at, const State& state) const
{
  if (!model_.boundary.introducer)
    return 1.0;
  const Mouth mouth = model_.conditions.twistBoundary(state, 0.0).mouth();
  const int last = model_.rod.nodes() - 2;
  const auto share = [&](int node) { return model_.rod.actingShare(std::clamp(node, 1, last), mouth); };
  return (1.0 - at.parameter) * share(at.node) + at.parameter * share(at.node + 1);
}

/** Sections of the other layers at an arc length.
 *  @param at location at which their angles are taken
 *  @param acting restShare() there */
InsertionForces::Side InsertionForces::othersAt(int k, double arc_length, const Location& at, double acting,
                                                const State& state) const
{
  Side side;
  for (int m = 0; m < stack_.count(); ++m)
  {
    const LayerProfile& profile = stack_.profile(m);
    std::size_t section = 0;
    while (section < profile.wire().sections.size() && profile.sectionEnd(section) < arc_length)
      ++section;
    if (m == k || section == profile.wire().sections.size())
      continue;
    const Section& part = profile.wire().sections[section];
    side.add(part.bending_stiffness, restAt(m, part.rest_curvature, at, state), acting);
  }
  return side;
}

/** First end of another layer's section between two arc lengths [m]; @p end without. */
double InsertionForces::nextEnd(int k, double begin, double end) const
{
  for (int m = 0; m < stack_.count(); ++m)
    for (std::size_t section = 0; m != k && section < stack_.profile(m).wire().sections.size(); ++section)
      if (stack_.profile(m).sectionEnd(section) > begin)
        end = std::min(end, stack_.profile(m).sectionEnd(section));
  return end;
}

/** Energy per length that a joint between two sections of a layer, or its tip, needs to advance [N]: the section before
 *  it replaces the one after it. The other layers are averaged over kBlur to both sides.
 *  @param after null at the tip */
double InsertionForces::jointForce(int k, double arc_length, const Section& before, const Section* after,
                                   const State& state) const
{
  const Location at = locate(arc_length);
  const Eigen::Vector3d moment =
      (1.0 - at.parameter) * momentAt(at.node, state) + at.parameter * momentAt(at.node + 1, state);
  const Eigen::Vector3d rest_before = restAt(k, before.rest_curvature, at, state);
  const Eigen::Vector3d rest_after =
      after != nullptr ? restAt(k, after->rest_curvature, at, state) : Eigen::Vector3d::Zero();
  double bent = 1.0;  // else held straight by the introducer
  if (model_.boundary.introducer)
  {
    const double straight = model_.rod.length() - state.inserted_length - model_.boundary.guide_length;
    bent = std::max(0.0, std::min(1.0, (arc_length - straight) / kBlur));
  }
  const double acting = restShare(at, state);
  double force = 0.0;
  double end = 0.0;
  for (double begin = arc_length - kBlur; begin < arc_length + kBlur; begin = end)
  {
    end = nextEnd(k, begin, arc_length + kBlur);
    Side now = othersAt(k, 0.5 * (begin + end), at, acting, state);
    Side then = now;
    then.add(before.bending_stiffness, rest_before, acting);
    if (after != nullptr)
      now.add(after->bending_stiffness, rest_after, acting);
    force += (end - begin) / (2.0 * kBlur) *
             (bent * (then.energyUnder(moment) - now.energyUnder(moment)) +
              (1.0 - bent) * (then.straightEnergy() - now.straightEnergy()));
  }
  const Eigen::Vector3d position = (1.0 - at.parameter) * state.position[at.node] +
                                   at.parameter * state.position[std::min(at.node + 1, model_.rod.nodes() - 1)];
  force += guide_.density(position) * (before.bending_stiffness - (after != nullptr ? after->bending_stiffness : 0.0));
  if (after == nullptr || !twists_.isActive(k) || at.node <= state.first_node ||
      at.node + 2 >= stack_.profile(k).rod().nodes())
    return force;
  const double torque =
      (1.0 - at.parameter) * twists_.of(k).torque(at.node) + at.parameter * twists_.of(k).torque(at.node + 1);
  return force - 0.5 * torque * torque * (1.0 / before.torsional_stiffness - 1.0 / after->torsional_stiffness);
}

double InsertionForces::gradient(int k, const State& state) const
{
  const LayerProfile& profile = stack_.profile(k);
  const std::vector<Section>& sections = profile.wire().sections;
  double force = 0.0;
  for (std::size_t m = 0; m < sections.size(); ++m)
    force +=
        jointForce(k, profile.sectionEnd(m), sections[m], m + 1 < sections.size() ? &sections[m + 1] : nullptr, state);
  for (const int i : profile.slidingNodes())
    if (i > state.first_node)
      force += gravityAtNode(k, i, state);
  return force;
}

double InsertionForces::wedging(int k, const State& state) const
{
  double force = 0.0;
  for (const int i : stack_.profile(k).slidingNodes())
    if (i > state.first_node)
      force += state.wall_force[i].norm() * widening(k, i, stack_.profile(k).slope(i));
  return force;
}

double InsertionForces::wallDrag(int k, const State& state) const
{
  double force = 0.0;
  for (int i = state.first_node; i < model_.rod.nodes(); ++i)
    if (!state.wall_force[i].isZero(0.0) && stack_.surfaceLayer(i) == k)
      force -= frictionForce(state, i, model_.settings.friction_slip).dot(tangentAt(state, i));
  return force;
}

double InsertionForces::motionDrag(int k, const LayerMotion& motion, const LayerSlides* slides, const State& state,
                                   double dt) const
{
  if (motion.travel == 0.0 && motion.gained == 0.0)
    return 0.0;
  const double speed = motion.travel / dt;
  double force = 0.0;
  for (int i = state.first_node; i < model_.rod.nodes(); ++i)
  {
    force += stack_.profile(k).rod().mass[i] * (motion.gained / (dt * dt) + model_.environment.damping * speed);
    if (stack_.surfaceLayer(i) != k)
      continue;
    Eigen::Vector3d velocity = state.velocity[i];
    if (slides != nullptr)
      velocity += slides->surface[i] / dt;
    force += model_.dragCoefficient(i, velocity.norm(), state) * speed;
  }
  return force;
}

double InsertionForces::loads(int k, const std::vector<NodalForce>& forces, const State& state)
{
  double against = 0.0;
  for (const NodalForce& load : forces)
    if (load.layer == k && load.node >= state.first_node)
      against -= load.force.dot(tangentAt(state, load.node));
  return against;
}

double InsertionForces::streamDrag(int k, const std::vector<NodalDrag>& drags, const LayerSlides* slides,
                                   const State& state, double dt) const
{
  double force = 0.0;
  for (const NodalDrag& drag : drags)
    if (const int i = drag.node; i >= state.first_node && stack_.surfaceLayer(i) == k)
      force -= drag.force(dt * state.velocity[i] + surfaceSlide(slides, i), dt).dot(tangentAt(state, i));
  return force;
}

Eigen::Vector3d tangentAt(const State& state, int node)
{
  const int before = std::max(state.first_node, node - 1);
  const int after = std::min(static_cast<int>(state.position.size()) - 1, node + 1);
  return (state.position[after] - state.position[before]).normalized();
}

}  // namespace endovascular_sim::rod
