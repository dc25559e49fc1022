#include "rod/mixed/mixed_stepper.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

EndHold atNode(const Boundary& boundary, EndHold hold)
{
  return boundary.introducer ? EndHold::kClamped : hold;
}

using MassMatrix = std::vector<std::array<double, 2>>;

/** Share of consistent mass at an edge's end, from ρA h² of the edge and of its neighbour. */
double consistentShare(double own, double neighbour)
{
  return own > 0.0 ? std::max(0.0, std::min(1.0, 1.0 - neighbour / own)) : 0.0;
}

/** Mass matrix of all nodes.
 *  @param density of every edge, per length [kg/m] */
MassMatrix massMatrix(const MixedRod& rod, const std::vector<double>& density)
{
  const std::vector<MixedEdge>& edges = rod.edges();
  // Euler–Maclaurin's end term is proportional to the rotation of the end: zero at a clamp.
  const bool held = rod.proximal().hold == EndHold::kClamped;
  const bool tip_held = rod.distal().hold == EndHold::kClamped;
  const auto weight = [&](std::size_t j) { return density[j] * edges[j].length * edges[j].length; };
  MassMatrix mass(edges.size() + 1, {0.0, 0.0});
  for (std::size_t j = 0; j < edges.size(); ++j)
  {
    const double before = consistentShare(weight(j), j > 0 ? weight(j - 1) : held * weight(j));
    const double after = consistentShare(weight(j), j + 1 < edges.size() ? weight(j + 1) : tip_held * weight(j));
    const double whole = density[j] * edges[j].length;
    mass[j][0] += whole * (0.5 - before / 6.0);
    mass[j + 1][0] += whole * (0.5 - after / 6.0);
    mass[j][1] += whole * (before + after) / 12.0;
  }
  return mass;
}

}  // namespace

MixedStepper::MixedStepper(const Wire& wire, Discretisation rod, Boundary boundary, Environment environment,
                           StepperSettings settings)
  : rod_(std::move(rod)),
    boundary_(std::move(boundary)),
    environment_(std::move(environment)),
    settings_(settings),
    contacts_(rod_, boundary_, settings_),
    model_(mixedEdges(wire, rod_.position), {atNode(boundary_, boundary_.proximal), boundary_.direction},
           {boundary_.distal, boundary_.direction})
{
  std::vector<double> density, immersed;
  for (int j = 0; j + 1 < rod_.nodes(); ++j)
  {
    MixedEdge& edge = model_.edge(j);
    edge.axial_compliance = 0.0;  // inextensible, as in the other schemes
    density.push_back(edge.linear_density);
    immersed.push_back(edge.linear_density - environment_.fluid_density * edge.cross_section);
  }
  motion_.assign(rod_.position.size(), Vector3d::Zero());
  mass_ = massMatrix(model_, density);
  const MassMatrix weight = massMatrix(model_, immersed);
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight_.push_back((weight[i][0] + weight[i][1] + (i > 0 ? weight[i - 1][1] : 0.0)) * environment_.gravity);
}

State MixedStepper::initialState(double inserted_length, double rotation) const
{
  State state = model_.straight(boundary_.origin, boundary_.direction);
  state.inserted_length = inserted_length;
  state.rotation = rotation;
  state.first_node = conditions().firstSimulatedNode(inserted_length);
  std::fill(state.twist_angle.begin(), state.twist_angle.end(), rotation);
  for (int i = 0; i < rod_.nodes(); ++i)
    state.position[i] = boundary_.origin + conditions().bodyPosition(i, inserted_length) * boundary_.direction;
  return state;
}

void MixedStepper::placePrescribedNodes(State& state, double inserted_length, double dt)
{
  const PlacedNodes placed = conditions().placePrescribedNodes(state, inserted_length, dt);
  for (int i = placed.begin; i < placed.end; ++i)
    begin_[i] = state.position[i] - dt * state.velocity[i];  // new nodes have no earlier position
  for (int i = placed.begin; i < placed.born; ++i)
    state.moment[i].setZero();
}

StepReport MixedStepper::step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                              contact::ContactSource* contacts, PhaseTimer& timer)
{
  if (!input.drags.empty())
    throw std::invalid_argument("MixedStepper: this scheme has no drag of streams");
  timer_ = &timer;
  contacts_.beginStep(input, contacts, pass, timer);
  StepReport report;
  report.solved = bisection_.advance(
      state, input, dt, report,
      [this, &report](State& part, const State& /*before*/, const StepInput& at, double part_dt, bool /*shortest*/)
      { return solveStep(part, at, part_dt, report); },
      [this] { contacts_.invalidate(); });
  report.max_strain = largestStrain(state);
  return report;
}

bool MixedStepper::solveStep(State& state, const StepInput& input, double dt, StepReport& report)
{
  begin_ = state.position;
  placePrescribedNodes(state, input.inserted_length, dt);
  state.rotation = input.rotation;
  contacts_.refresh(state, report);
  for (int solve = 0; solve < settings_.max_iterations; ++solve)
  {
    relaxTwist(state, input.tip_torque);
    {
      PhaseTimer::Scope scope(*timer_, Phase::kAssembly);
      contacts_.prepare(state, dt);
      assemble(state, input, dt, solve == 0);
    }
    ++report.solves;
    bool shifted = false;
    if (!solveActiveSet(state, dt, report, shifted))
      return false;
    const double factor = truncation(state, report);
    accept(state, factor);
    if (contacts_.present())
    {
      contacts_.detect(state, report);
      if (contacts_.set().stale)
        break;  // a stale contact set serves one solve per step
    }
    if (factor == 1.0 && !shifted && largestStrain(state) <= settings_.strain_tolerance &&
        !contacts_.foundUnknown(state))
      break;
    const bool last = solve + 1 == settings_.max_iterations;
    report.hit_iteration_limit += last;
    if (last && !restoreLengths(state, input, dt, report))
      return false;
  }
  finish(state, dt);
  return true;
}

void MixedStepper::relaxTwist(State& state, double tip_torque)
{
  last_tip_torque_ = tip_torque;
  twist_active_ = MixedTwist::matters(model_, tip_torque);
  if (!twist_active_)
  {
    std::fill(state.twist_angle.begin() + state.first_node, state.twist_angle.end(), state.rotation);
    state.hand_torque = 0.0;
    return;
  }
  PhaseTimer::Scope scope(*timer_, Phase::kTwist);
  const TwistBoundary boundary = conditions().twistBoundary(state, tip_torque);
  twist_.relax(model_, boundary, state);
}

void MixedStepper::assemble(const State& state, const StepInput& input, double dt, bool first_solve)
{
  base_.reset(model_.size(state));
  gradient_.assign(static_cast<std::size_t>(base_.size()), 0.0);
  model_.assemble(state, gradient_, base_);
  if (twist_active_)
    twist_.assemble(model_, state, gradient_, base_);
  addInertia(state, dt);
  friction_.collect(state, begin_, &rod_.mass, dt, first_solve);
  friction_.linearise();
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    addNodeTerms(i, state, dt, first_solve);
  addGuide(state);
  for (const NodalForce& load : input.forces)
    if (load.node >= state.first_node)
      for (int axis = 0; axis < 3; ++axis)
        gradient_[model_.positionRow(state, load.node) + axis] -= load.force[axis];
}

/** Adds gradient and second derivative of ½(x − x*)ᵀM(x − x*)/Δt² + ½c(x − x⁰)ᵀM(x − x⁰)/Δt, x* = x⁰ + Δt v. */
void MixedStepper::addInertia(const State& state, double dt)
{
  const double damped = 1.0 + dt * environment_.damping;
  const double scale = 1.0 / (dt * dt);
  Vector3d change =
      damped * (state.position[state.first_node] - begin_[state.first_node]) - dt * state.velocity[state.first_node];
  for (int i = state.first_node; i < rod_.nodes(); ++i)
  {
    const int row = model_.positionRow(state, i);
    const double own = scale * mass_[i][0];
    for (int axis = 0; axis < 3; ++axis)
    {
      gradient_[row + axis] += own * change[axis];
      base_.at(row + axis, row + axis) += own * damped;
    }
    if (i + 1 == rod_.nodes())
      break;
    const Vector3d next = damped * (state.position[i + 1] - begin_[i + 1]) - dt * state.velocity[i + 1];
    const double shared = scale * mass_[i][1];
    const int next_row = model_.positionRow(state, i + 1);
    for (int axis = 0; shared != 0.0 && axis < 3; ++axis)
    {
      gradient_[row + axis] += shared * next[axis];
      gradient_[next_row + axis] += shared * change[axis];
      base_.at(next_row + axis, row + axis) += shared * damped;
    }
    change = next;
  }
}

void MixedStepper::addBlock(const State& state, int node, const Eigen::Matrix3d& block)
{
  const int r = model_.positionRow(state, node);
  for (int col = 0; col < 3; ++col)
    for (int line = col; line < 3; ++line)
      base_.at(r + line, r + col) += block(line, col);
}

/** Adds weight and drag of the fluid. */
void MixedStepper::addNodeTerms(int node, const State& state, double dt, bool first_solve)
{
  const BoundaryConditions held = conditions();
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  Vector3d force = -weight_[node];
  if (environment_.fluid_density > 0.0 &&
      (!boundary_.introducer || held.bodyPosition(node, state.inserted_length) >= 0.0))
  {
    const Vector3d travel = state.position[node] - begin_[node];
    const Vector3d velocity = first_solve ? state.velocity[node] : Vector3d(travel / dt);
    const double drag = environment_.fluid_density * environment_.drag_coefficient * rod_.radius[node] *
                        rod_.cell_length[node] * velocity.norm() / dt;
    block.diagonal().array() += drag;
    force += drag * travel;
  }
  addBlock(state, node, block);
  for (int axis = 0; axis < 3; ++axis)
    gradient_[model_.positionRow(state, node) + axis] += force[axis];
}

/** Adds the potential of the introducer's guide, on the chords. */
void MixedStepper::addGuide(const State& state)
{
  guide_.forEachEdge(rod_, state,
                     [this, &state](int edge, const GuidedEdge& term)
                     {
                       addBlock(state, edge, term.first);
                       addBlock(state, edge + 1, term.second);
                       const int row = model_.positionRow(state, edge);
                       const int next_row = model_.positionRow(state, edge + 1);
                       for (int col = 0; col < 3; ++col)
                       {
                         gradient_[row + col] += term.gradient[0][col];
                         gradient_[next_row + col] += term.gradient[1][col];
                         for (int line = 0; line < 3; ++line)
                           base_.at(next_row + line, row + col) += term.across(line, col);
                       }
                     });
}

/** Largest strain of the edges between nodes that are not both prescribed. */
double MixedStepper::largestStrain(const State& state) const
{
  double worst = 0.0;
  for (int j = state.first_node; j + 1 < rod_.nodes(); ++j)
    if (!(conditions().isPrescribed(j, state) && conditions().isPrescribed(j + 1, state)))
      worst = std::max(worst, std::abs(model_.strain(state, j)));
  return worst;
}

void MixedStepper::finish(State& state, double dt) const
{
  friction_.finish(state, begin_);
  const double inverse = 1.0 / dt;
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    if (!conditions().isPrescribed(i, state))
      state.velocity[i] = inverse * (state.position[i] - begin_[i]);
}

Energy MixedStepper::energy(const State& state)
{
  Energy energy;
  PhaseTimer unused;
  timer_ = &unused;
  State relaxed = state;
  relaxTwist(relaxed, last_tip_torque_);
  if (twist_active_)
    return twist_.energy(relaxed);
  energy.bending = model_.bendingEnergy(state);
  return energy;
}

}  // namespace endovascular_sim::rod
