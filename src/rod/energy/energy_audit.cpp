#include "rod/energy/energy_audit.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kShare = 1.0 / 32.0;  // of a part's motion, for central differences

/** Adds a multiple of the differences between two states' angles to those of a third one. */
void addAngles(const State& from, const State& to, double factor, State& state)
{
  const auto add = [factor](const std::vector<double>& a, const std::vector<double>& b, std::vector<double>& angle)
  {
    for (std::size_t j = 0; j < angle.size(); ++j)
      angle[j] += factor * (b[j] - a[j]);
  };
  add(from.twist_angle, to.twist_angle, state.twist_angle);
  state.rotation += factor * (to.rotation - from.rotation);
  for (std::size_t k = 0; k < state.layers.size(); ++k)
  {
    add(from.layers[k].twist_angle, to.layers[k].twist_angle, state.layers[k].twist_angle);
    state.layers[k].rotation += factor * (to.layers[k].rotation - from.layers[k].rotation);
  }
}

/** Adds a multiple of an angle per edge to the angles of a state. */
void addAngles(const std::vector<double>& angle, double factor, State& state)
{
  const auto add = [&angle, factor](std::vector<double>& twist)
  {
    for (std::size_t j = 0; j < angle.size(); ++j)
      twist[j] += factor * angle[j];
  };
  add(state.twist_angle);
  for (LayerState& layer : state.layers)
    add(layer.twist_angle);
}

void copyAngles(const State& from, State& state)
{
  state.twist_angle = from.twist_angle;
  state.rotation = from.rotation;
  for (std::size_t k = 0; k < state.layers.size(); ++k)
  {
    state.layers[k].twist_angle = from.layers[k].twist_angle;
    state.layers[k].rotation = from.layers[k].rotation;
  }
}

double layerRotationChange(const State& before, const State& after, int hand)
{
  return handleState(after, hand).rotation - handleState(before, hand).rotation;
}

/** Motion of the surface at a node in a part [m]. */
Eigen::Vector3d surfaceTravel(const AcceptedPart& part, int node)
{
  Eigen::Vector3d travel = part.after.position[node] - part.begin[node];
  if (!part.slides.empty())
    travel += part.slides[node].surface;
  return travel;
}

/** Motion of the wall at a node in a part [m]. */
Eigen::Vector3d wallTravel(const AcceptedPart& part, int node)
{
  return part.wall != nullptr ? part.wall->displacement[node] : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/** Turn of the wall about the wire's axis at a node in a part [rad]. */
double wallTurn(const AcceptedPart& part, int node)
{
  return part.wall_turn != nullptr ? (*part.wall_turn)[node] : 0.0;
}

int hands(const State& state)
{
  return std::max<int>(1, static_cast<int>(state.layers.size()));
}

}  // namespace

void ResistingForces::reset(std::size_t nodes)
{
  friction.assign(nodes, Eigen::Vector3d::Zero());
  damping.assign(nodes, 0.0);
  drag.assign(nodes, 0.0);
}

State completed(const State& state, const Boundary& boundary, const BoundaryConditions& conditions)
{
  State all = state;
  for (int i = 0; i < state.first_node; ++i)
    all.position[i] = boundary.origin + conditions.bodyPosition(i, state.inserted_length) * boundary.direction;
  std::fill_n(all.twist_angle.begin(), state.first_node, state.rotation);
  for (LayerState& layer : all.layers)
    std::fill_n(layer.twist_angle.begin(), state.first_node, layer.rotation);
  return all;
}

double kineticEnergy(const Discretisation& rod, const State& state)
{
  double sum = 0.0;
  for (int i = state.first_node; i < rod.nodes(); ++i)
    sum += 0.5 * rod.mass[i] * state.velocity[i].squaredNorm();
  return sum;
}

void EnergyAudit::beginStep(const Discretisation& rod, const State& state)
{
  sums_.kinetic = kineticEnergy(rod, state);
}

void EnergyAudit::endStep(bool solved)
{
  if (solved)
  {
    sums_.pending.turnover += std::abs(sums_.pending.stored());
    sums_.sum += sums_.pending;
    sums_.last = sums_.pending_last;
  }
  else
  {
    sums_.sum.kinetic -= sums_.kinetic;
    sums_.sum.rejected += sums_.kinetic;
    sums_.sum.turnover += sums_.kinetic;
  }
  sums_.pending = EnergyBalance();
  sums_.pending_last = sums_.last;
}

void EnergyAudit::addPart(const AcceptedPart& part)
{
  turn_balance_ = 0.0;
  addHands(part);
  addLoads(part);
  addStream(part);
  addMotion(part);
  addPotentials(part);
  addFriction(part);
  addTensions(part);
  addContact(part);
  addWallMotion(part);
  sums_.pending.turn_error += turn_balance_;
}

void EnergyAudit::addHands(const AcceptedPart& part)
{
  double push = 0.0;
  double turn = 0.0;
  for (int k = 0; k < hands(part.after); ++k)
  {
    const HandleState now = handleState(part.after, k);
    push += now.force * (now.inserted_length - handleState(part.before, k).inserted_length);
    turn += now.torque * layerRotationChange(part.before, part.after, k);
  }
  sums_.pending.push += push;
  sums_.pending.turn += turn;
  sums_.pending.turnover += std::abs(push) + std::abs(turn);
  turn_balance_ += turn;
}

/** External loads; the distal end's hold by its translation and its rotation about the wire. */
void EnergyAudit::addLoads(const AcceptedPart& part)
{
  double work = 0.0;
  for (const NodalForce& load : part.input.forces)
    if (load.node >= part.after.first_node)
      work += load.force.dot(part.after.position[load.node] - part.begin[load.node]);
  work -= part.after.distal_force.dot(part.after.distal.displacement - part.before.distal.displacement);
  double torque = 0.0;
  const std::size_t last = part.after.twist_angle.size() - 1;
  for (std::size_t j = 0; j < part.input.edge_torque.size(); ++j)
    torque += part.input.edge_torque[j] * (part.after.twist_angle[j] - part.before.twist_angle[j]);
  torque += part.input.tip_torque * (part.after.twist_angle[last] - part.before.twist_angle[last]);
  torque += part.after.distal_torque * (part.after.distal.rotation - part.before.distal.rotation);
  sums_.pending.loads += work + torque;
  sums_.pending.turnover += std::abs(work) + std::abs(torque);
  turn_balance_ += torque;
}

/** Drag of streams along the motion of the surface. */
void EnergyAudit::addStream(const AcceptedPart& part)
{
  double work = 0.0;
  for (const NodalDrag& drag : part.input.drags)
    if (drag.node >= part.after.first_node)
    {
      const Eigen::Vector3d travel = surfaceTravel(part, drag.node);
      work += drag.force(travel, part.dt).dot(travel);
    }
  sums_.pending.stream += work;
  sums_.pending.turnover += std::abs(work);
}

/** Inertia of the free nodes, damping and drag. */
void EnergyAudit::addMotion(const AcceptedPart& part)
{
  const State& after = part.after;
  for (int i = after.first_node; i < part.rod.nodes(); ++i)
  {
    const NodeSlide slide = part.slides.empty() ? NodeSlide() : part.slides[i];
    const Eigen::Vector3d travel = after.position[i] - part.begin[i];
    const Eigen::Vector3d in_fluid = travel - wallTravel(part, i);
    sums_.pending.damping += part.forces.damping[i] * (in_fluid + slide.mass).squaredNorm();
    sums_.pending.drag += part.forces.drag[i] * (in_fluid + slide.surface).squaredNorm();
    if (part.conditions.isPrescribed(i, after))
      continue;
    const Eigen::Vector3d velocity = (travel + slide.mass) / part.dt;
    const Eigen::Vector3d earlier = part.before.velocity[i] + (slide.mass - slide.mass_gained) / part.dt;
    const double mass = part.rod.mass[i];
    sums_.pending.kinetic += 0.5 * mass * (velocity.squaredNorm() - earlier.squaredNorm());
    sums_.pending.inertia += 0.5 * mass * (velocity - earlier).squaredNorm();
  }
}

/** Potentials: their change, and the work of their forces at the end along the motion of positions and angles. Along
 *  the positions, the material follows the edges without turning about them; the rest of its turn is that of the
 *  angles. */
void EnergyAudit::addPotentials(const AcceptedPart& part)
{
  const State begin = completed(part.before, part.boundary, part.conditions);
  const State faded = completed(part.after, part.boundary, part.conditions);
  State end = faded;
  end.curvature_offset = begin.curvature_offset;  // they fade after the part
  const int from = end.first_node;
  const int n = part.rod.nodes();

  State moved = end;
  const auto alongPositions = [&](double share, bool free_only = false)
  {
    for (int i = 0; i < n; ++i)
      if (!free_only || (i >= from && !part.conditions.isPrescribed(i, end)))
        moved.position[i] = end.position[i] + share * (end.position[i] - begin.position[i]);
      else
        moved.position[i] = end.position[i];
    copyAngles(end, moved);
    addAngles(part.frame_turns, -share, moved);
    return part.potential(moved, from);
  };
  addResidual(part, ((0.5 / kShare) * (alongPositions(kShare, true) - alongPositions(-kShare, true))).sum());
  const PotentialEnergy by_positions = (0.5 / kShare) * (alongPositions(kShare) - alongPositions(-kShare));
  const PotentialEnergy at_begin = alongPositions(-1.0);  // positions of the beginning, angles of the end
  copyAngles(begin, moved);
  const PotentialEnergy with_insertion = part.potential(moved, from);  // of the beginning, with the end's insertion
  const auto alongAngles = [&](double share)
  {
    moved = end;
    addAngles(begin, end, share, moved);
    addAngles(part.frame_turns, share, moved);
    return part.potential(moved, from);
  };
  const PotentialEnergy by_angles = (0.5 / kShare) * (alongAngles(kShare) - alongAngles(-kShare));
  const PotentialEnergy first = part.potential(begin, from);
  const PotentialEnergy last = part.potential(end, from);
  const PotentialEnergy final = part.potential(faded, from);
  const PotentialEnergy change = final - first;
  sums_.pending.bending += change.bending;
  sums_.pending.twist += change.twist;
  sums_.pending.guide += change.guide;
  sums_.pending.gravity += change.gravity;
  sums_.pending.resampling += (last - final).sum();
  addChangeOfNodes(first, final);
  // The energy of the twist refers to angles alone; that of the hold is singular where it passes the middle of an edge.
  sums_.pending.positions += by_positions.sum() - (last - at_begin).sum();
  sums_.pending.twisting += by_angles.sum() - (at_begin - with_insertion).sum() + (at_begin - with_insertion).twist -
                            (at_begin - first).twist;
  const double by_insertion = (with_insertion - first).sum() - (with_insertion - first).twist;
  sums_.pending.configurational += by_insertion;
  sums_.pending.insertion += part.insertion_work - by_insertion;
  turn_balance_ -= by_angles.sum();
}

/** Friction of the wall along the surface and about the axis, and friction between layers. */
void EnergyAudit::addFriction(const AcceptedPart& part)
{
  for (int i = part.after.first_node; i < part.rod.nodes(); ++i)
    sums_.pending.wall_friction += part.forces.friction[i].dot(surfaceTravel(part, i) - wallTravel(part, i));
  double rolling = 0.0;
  for (const TwistFriction& friction : part.about_axis)
  {
    const double angle = part.surface_angle[friction.node];
    rolling += friction.pull(angle - friction.begin_angle) *
               (angle - part.surface_begin[friction.node] - wallTurn(part, friction.node));
  }
  sums_.pending.wall_rolling += rolling;
  sums_.pending.layer_friction += part.layer_friction_push + part.layer_friction_turn;
  turn_balance_ -= rolling + part.layer_friction_turn;
}

/** Tensions on edges that turn: their work would vanish at the mean of the directions before and after. */
void EnergyAudit::addTensions(const AcceptedPart& part)
{
  const std::vector<Eigen::Vector3d>& x = part.after.position;
  for (int j = part.after.first_node; j + 1 < part.rod.nodes(); ++j)
  {
    const Eigen::Vector3d edge = x[j + 1] - x[j];
    sums_.pending.lengths += part.after.tension[j] * edge.normalized().dot(edge - part.begin[j + 1] + part.begin[j]);
  }
}

/** Residual of the equations of the free nodes at the end of a part, times their motion.
 *  @param by_free_nodes derivative of the potentials along the motion of the free nodes [J] */
void EnergyAudit::addResidual(const AcceptedPart& part, double by_free_nodes)
{
  const State& after = part.after;
  const int first = after.first_node;
  const auto isFree = [&](int node) { return !part.conditions.isPrescribed(node, after); };
  const auto travelOf = [&](int node) -> Eigen::Vector3d
  { return isFree(node) ? Eigen::Vector3d(after.position[node] - part.begin[node]) : Eigen::Vector3d::Zero(); };
  double work = by_free_nodes;
  for (int i = first; i < part.rod.nodes(); ++i)
  {
    const NodeSlide slide = part.slides.empty() ? NodeSlide() : part.slides[i];
    const Eigen::Vector3d travel = travelOf(i);
    const Eigen::Vector3d gained = (travel + slide.mass_gained) / part.dt - part.before.velocity[i];
    const Eigen::Vector3d in_fluid = travel - wallTravel(part, i);
    work +=
        travel.dot(part.rod.mass[i] / part.dt * gained + part.forces.damping[i] * (in_fluid + slide.mass) +
                   part.forces.drag[i] * (in_fluid + slide.surface) + part.forces.friction[i] - after.wall_force[i]);
    if (i + 1 < part.rod.nodes())
    {
      const Eigen::Vector3d direction = (after.position[i + 1] - after.position[i]).normalized();
      work += after.tension[i] * direction.dot(travelOf(i + 1) - travel);
    }
  }
  for (const NodalForce& load : part.input.forces)
    if (load.node >= first)
      work -= load.force.dot(travelOf(load.node));
  for (const NodalDrag& drag : part.input.drags)
    if (drag.node >= first)
      work -= drag.force(surfaceTravel(part, drag.node), part.dt).dot(travelOf(drag.node));
  sums_.pending.iteration -= work;
}

void EnergyAudit::addContact(const AcceptedPart& part)
{
  const auto n = static_cast<std::size_t>(part.rod.nodes());
  const bool same_nodes = sums_.pending_last.radius.size() == n;
  std::vector<double> radius = part.rod.radius;
  for (std::size_t i = 0; sums_.least_radius.size() == n && i < n; ++i)
    radius[i] = std::max(radius[i], sums_.least_radius[i]);
  double work = 0.0;
  double widened = 0.0;
  double inflated = 0.0;
  for (std::size_t i = static_cast<std::size_t>(part.after.first_node); i < n; ++i)
  {
    const Eigen::Vector3d& force = part.after.wall_force[i];
    work -= force.dot(part.after.position[i] - part.begin[i] - wallTravel(part, static_cast<int>(i)));
    if (!same_nodes || force.isZero(0.0))
      continue;
    const double growth = radius[i] - sums_.pending_last.radius[i];
    const double own_growth = part.rod.radius[i] - sums_.pending_last.own_radius[i];
    widened += force.norm() * growth;
    inflated += force.norm() * (growth - own_growth);
  }
  sums_.pending.pressure += inflated;
  sums_.pending.wall += part.wall_energy - sums_.pending_last.wall_energy;
  sums_.pending.contact += work + widened - (part.wall_energy - sums_.pending_last.wall_energy);
  sums_.pending_last.wall_energy = part.wall_energy;
  sums_.pending_last.radius = std::move(radius);
  sums_.pending_last.own_radius = part.rod.radius;
}

/** Work of a moving wall: its normal forces and friction, and the resistance of the fluid that moves with it. Damping
 * and drag act on the motion relative to that fluid. */
void EnergyAudit::addWallMotion(const AcceptedPart& part)
{
  if (part.wall == nullptr)
    return;
  double work = 0.0;
  for (int i = part.after.first_node; i < part.rod.nodes(); ++i)
  {
    const NodeSlide slide = part.slides.empty() ? NodeSlide() : part.slides[i];
    const Eigen::Vector3d moved = wallTravel(part, i);
    const Eigen::Vector3d in_fluid = part.after.position[i] - part.begin[i] - moved;
    work +=
        moved.dot(part.after.wall_force[i] - part.forces.friction[i] -
                  part.forces.damping[i] * (in_fluid + slide.mass) - part.forces.drag[i] * (in_fluid + slide.surface));
  }
  double turn = 0.0;
  for (const TwistFriction& friction : part.about_axis)
    turn -= friction.pull(part.surface_angle[friction.node] - friction.begin_angle) * wallTurn(part, friction.node);
  sums_.pending.wall_motion += work + turn;
  sums_.pending.turnover += std::abs(work) + std::abs(turn);
  turn_balance_ += turn;
}

/** Adds the change of the potentials since the last part, e.g. by other nodes.
 *  @param first at the beginning of a part
 *  @param final at its end */
void EnergyAudit::addChangeOfNodes(const PotentialEnergy& first, const PotentialEnergy& final)
{
  if (sums_.pending_last.started)
  {
    PotentialEnergy change = first - sums_.pending_last.potential;
    change.gravity = 0.0;  // of the nodes simulated at that time
    sums_.pending.bending += change.bending;
    sums_.pending.twist += change.twist;
    sums_.pending.guide += change.guide;
    sums_.pending.resampling -= change.sum();
  }
  sums_.pending_last.started = true;
  sums_.pending_last.potential = final;
}

void EnergyAudit::addValve(double push, double turn)
{
  sums_.sum.push += push;
  sums_.sum.turn += turn;
  sums_.sum.turnover += std::abs(push) + std::abs(turn);
  sums_.sum.valve += push + turn;
}

/** The normal forces of the wall count as work of the contacts already. */
void EnergyAudit::addMovedWall(double work)
{
  sums_.sum.loads += work;
  sums_.sum.contact += work;
  sums_.sum.turnover += std::abs(work);
}

}  // namespace endovascular_sim::rod
