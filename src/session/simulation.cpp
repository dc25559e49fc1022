#include "session/simulation.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "rod/kkt_stepper.h"
#include "rod/mixed_stepper.h"
#include "rod/paper_stepper.h"
#include "vessel/centreline_curvature.h"

namespace endovascular_sim::session
{
namespace
{

constexpr double kMaxHandSpeed = 1.0;            // m/s
constexpr double kMaxHandTurn = 60.0;            // rad/s
constexpr double kMaxRotationPerSubstep = 0.05;  // rad
constexpr double kGripTime = 10e-3;              // s in which the grip follows the force
constexpr double kSlipBand = 0.1;                // of the limit, over which the grip lets go
constexpr double kSamplingPeriod = 10e-3;        // s between two looks at the wire's shape

rod::EndHold hold(EndCondition condition)
{
  switch (condition)
  {
    case EndCondition::kPinned:
      return rod::EndHold::kPinned;
    case EndCondition::kClamped:
      return rod::EndHold::kClamped;
    case EndCondition::kFree:
      break;
  }
  return rod::EndHold::kFree;
}

rod::Boundary boundaryOf(const Scene& scene, const EntryPose& entry)
{
  rod::Boundary boundary;
  boundary.introducer = scene.introducer;
  boundary.origin = entry.position;
  boundary.direction = entry.direction;
  boundary.director = entry.d1;
  boundary.guide_length = scene.solver.guide_length;
  boundary.proximal = hold(scene.proximal_end);
  boundary.distal = hold(scene.distal_end);
  boundary.distal_twist_held = scene.distal.twist_held;
  return boundary;
}

std::uint64_t stepsIn(double seconds, const Scene& scene)
{
  return static_cast<std::uint64_t>(std::max(1.0, std::round(seconds / scene.solver.time_step)));
}

std::unique_ptr<rod::AdaptiveSampling> makeSampling(const Scene& scene, const EntryPose& entry,
                                                    const vessel::CentrelineTree* centreline)
{
  if (scene.sampling.kind != SamplingKind::kAdaptive)
    return nullptr;
  rod::SamplingSettings settings;
  settings.min_edge = scene.sampling.min_edge;
  settings.max_edge = scene.sampling.max_edge;
  settings.turn_per_edge = scene.sampling.turn_per_edge;
  settings.min_age = static_cast<int>(stepsIn(scene.sampling.min_age, scene) / stepsIn(kSamplingPeriod, scene));
  rod::CurvatureAhead ahead;
  if (centreline != nullptr && !centreline->branches.empty())
    ahead = [curvature = vessel::CentrelineCurvature(*centreline)](const Eigen::Vector3d& place)
    { return curvature.at(place); };
  return std::make_unique<rod::AdaptiveSampling>(scene.instrument.wire, boundaryOf(scene, entry), settings, ahead);
}

bool isStill(const DriveProfile& profile)
{
  return profile.points.empty() && profile.amplitude == 0.0;
}

/** Only `kkt` moves a held far end, or holds its twist. */
void checkFarEnd(const Scene& scene)
{
  const DistalScene& distal = scene.distal;
  if (scene.solver.scheme == "kkt" ||
      (!distal.twist_held && isStill(distal.displacement) && isStill(distal.tilt) && isStill(distal.rotation)))
    return;
  throw InputError(scene.file, "solver.scheme",
                   "'" + scene.solver.scheme + "' does not move a far end or hold its twist; use kkt");
}

std::unique_ptr<rod::Stepper> makeMixedStepper(const Scene& scene, rod::Discretisation nodes,
                                               const rod::Boundary& boundary, const rod::Environment& environment,
                                               const rod::StepperSettings& settings)
{
  const rod::Wire& wire = scene.instrument.wire;
  const auto refuse = [&scene](const std::string& why)
  { throw InputError(scene.file, "solver.scheme", "'mixed' does not simulate " + why + "; use kkt"); };
  for (const PointLoad& load : scene.loads.point_loads)
    if (load.torque != 0.0 && scene.distal_end == EndCondition::kClamped)
      refuse("a torque at a clamped tip");
  return std::make_unique<rod::MixedStepper>(wire, std::move(nodes), boundary, environment, settings);
}

std::unique_ptr<rod::Stepper> makeStepper(const Scene& scene, const EntryPose& entry,
                                          const rod::AdaptiveSampling* sampling)
{
  checkFarEnd(scene);
  rod::Environment environment;
  environment.gravity = scene.loads.gravity;
  environment.fluid_density = scene.loads.fluid_density;
  environment.drag_coefficient = scene.loads.drag_coefficient;
  environment.damping = scene.loads.damping;
  rod::StepperSettings settings;
  settings.linear_solver = scene.solver.linear_solver;
  settings.max_solves = scene.solver.max_newton;
  settings.strain_tolerance = scene.solver.strain_tolerance;
  settings.contact_stiffness = scene.solver.contact_stiffness;
  settings.contact_margin = scene.solver.contact_margin;
  rod::Discretisation wire = sampling != nullptr
                                 ? sampling->discretisation()
                                 : rod::discretiseUniformly(scene.instrument.wire, scene.sampling.nodes);
  if (scene.solver.scheme == "paper")
    return std::make_unique<rod::PaperStepper>(std::move(wire), boundaryOf(scene, entry), environment, settings);
  if (scene.solver.scheme == "mixed")
    return makeMixedStepper(scene, std::move(wire), boundaryOf(scene, entry), environment, settings);
  return std::make_unique<rod::KktStepper>(std::move(wire), boundaryOf(scene, entry), environment, settings);
}

}  // namespace

Simulation::Simulation(const Scene& scene, const EntryPose& entry, contact::ContactSource* contacts,
                       const vessel::CentrelineTree* centreline)
  : scene_(scene),
    distal_direction_(scene.distal.direction.isZero() ? entry.direction : scene.distal.direction.normalized()),
    contacts_(contacts),
    sampling_(makeSampling(scene, entry, centreline)),
    sampling_every_(stepsIn(kSamplingPeriod, scene)),
    stepper_(makeStepper(scene, entry, sampling_.get()))
{
  if (sampling_ && !stepper_->resample(sampling_->discretisation()))
    throw InputError(scene.file, "sampling.kind",
                     "scheme '" + scene.solver.scheme + "' keeps its nodes; set sampling.kind: uniform");
  const rod::Discretisation& wire = stepper_->discretisation();
  // The introducer's guide must stay filled: the wire's end cannot be pushed into it.
  max_insertion_ = wire.length() - scene.solver.guide_length - 3.0 * wire.rest_length.front();
  if (scene.introducer && scene.drive.initial_insertion > max_insertion_)
    throw InputError(scene.file, "drive.initial_insertion",
                     "leaves less of the wire outside than the introducer's guide; at most " +
                         std::to_string(max_insertion_) + " m");
  const double insertion = scene.introducer ? std::max(0.0, scene.drive.insertionAt(0.0)) : 0.0;
  state_ = stepper_->initialState(insertion, scene.drive.rotationAt(0.0));
  while (sampling_ && sampling_->update(state_))
    stepper_->resample(sampling_->discretisation());
}

/** Grip of the hand, 1 firm to 0 slipping, after a step in which the wire resisted the wanted motion. It follows the
 *  force with a delay: a grip that answered at once would chatter, because the wire's inertia answers every change. */
double Simulation::nextGrip(double grip, double wanted, double resistance, double limit) const
{
  const double against = wanted > 0.0 ? resistance : -resistance;
  const double target = std::max(0.0, std::min(1.0, (limit - against) / (kSlipBand * limit)));
  return grip + std::min(1.0, scene_.solver.time_step / kGripTime) * (target - grip);
}

HandCommand Simulation::allowedMotion(const HandCommand& command)
{
  const double dt = scene_.solver.time_step;
  HandCommand motion;
  if (!scene_.introducer)
  {
    const double most = kMaxHandTurn * dt;
    motion.rotation = std::max(-most, std::min(most, command.rotation - state_.rotation));
    return motion;
  }
  double wanted = command.insertion - slipped_insertion_ - state_.inserted_length;
  wanted = std::max(-kMaxHandSpeed * dt, std::min(kMaxHandSpeed * dt, wanted));
  grip_ = nextGrip(grip_, wanted, state_.hand_force, scene_.drive.force_limit);
  motion.insertion = grip_ * wanted;
  const double reached = std::max(0.0, std::min(max_insertion_, state_.inserted_length + motion.insertion));
  motion.insertion = reached - state_.inserted_length;
  slipped_insertion_ += wanted - motion.insertion;

  double turn = command.rotation - slipped_rotation_ - state_.rotation;
  turn = std::max(-kMaxHandTurn * dt, std::min(kMaxHandTurn * dt, turn));
  turning_grip_ = nextGrip(turning_grip_, turn, state_.hand_torque, scene_.drive.torque_limit);
  motion.rotation = turning_grip_ * turn;
  slipped_rotation_ += turn - motion.rotation;
  return motion;
}

void Simulation::applyLoads(rod::StepInput& input) const
{
  const rod::Discretisation& wire = stepper_->discretisation();
  const double end_time = time() + scene_.solver.time_step;
  for (const PointLoad& load : scene_.loads.point_loads)
  {
    const double share = load.ramp_time > 0.0 ? std::min(1.0, end_time / load.ramp_time) : 1.0;
    input.tip_torque += share * load.torque;
    if (load.force.isZero(0.0))
      continue;
    const auto after = std::upper_bound(wire.position.begin(), wire.position.end(), load.position);
    const int edge = std::max(0, std::min(wire.nodes() - 2, static_cast<int>(after - wire.position.begin()) - 1));
    const double t = std::max(0.0, std::min(1.0, (load.position - wire.position[edge]) / wire.rest_length[edge]));
    input.forces.push_back({edge, (1.0 - t) * share * load.force});
    input.forces.push_back({edge + 1, t * share * load.force});
  }
}

rod::EndMotion Simulation::distalMotionAt(double t) const
{
  const DistalScene& distal = scene_.distal;
  return {distal.displacement.at(t) * distal_direction_, distal.tilt.at(t) * distal.tilt_axis.normalized(),
          distal.rotation.at(t)};
}

/** Old contacts are good for the edges that they were found at. */
void Simulation::resample()
{
  if (!sampling_ || steps_ % sampling_every_ != 0 || stepper_->contactSet().stale)
    return;
  PhaseTimer::Scope scope(timer_, Phase::kSampling);
  if (sampling_->update(state_))
    stepper_->resample(sampling_->discretisation());
}

void Simulation::step(const HandCommand& command)
{
  timer_.reset();
  resample();
  const HandCommand motion = allowedMotion(command);
  const rod::EndMotion from = state_.distal;
  const rod::EndMotion to = distalMotionAt(time() + scene_.solver.time_step);
  const double travel = std::max(std::abs(motion.insertion), (to.displacement - from.displacement).norm());
  const double turn =
      std::max({std::abs(motion.rotation), std::abs(to.rotation - from.rotation), (to.tilt - from.tilt).norm()});
  const double substeps_wanted = std::max(travel / scene_.solver.max_travel_per_substep, turn / kMaxRotationPerSubstep);
  const int substeps = std::max(1, static_cast<int>(std::ceil(substeps_wanted - 1e-9)));
  const double insertion = state_.inserted_length;
  const double rotation = state_.rotation;
  report_ = rod::StepReport();
  std::uint32_t pass = 0;
  for (int k = 1; k <= substeps; ++k)
  {
    rod::StepInput input;
    input.step = steps_;
    input.substep = static_cast<std::uint32_t>(k - 1);
    const double share = static_cast<double>(k) / substeps;
    // Blind, the hand is held: what it commands meanwhile follows when contact sets come again.
    const bool blind = contacts_ != nullptr && stepper_->contactSet().stale;
    input.inserted_length = blind ? state_.inserted_length : insertion + share * motion.insertion;
    input.rotation = blind ? state_.rotation : rotation + share * motion.rotation;
    input.distal = blind ? state_.distal : rod::between(from, to, share);
    applyLoads(input);
    report_.add(stepper_->step(state_, input, scene_.solver.time_step / substeps, pass, contacts_, timer_));
  }
  ++steps_;
  state_hash_ = state_.hash();
  trajectory_.add(state_hash_);
}

void Simulation::setState(rod::State state)
{
  state_ = std::move(state);
  stepper_->invalidateContacts();
}

contact::Query Simulation::initialQuery() const
{
  contact::Query query;
  query.margin = scene_.solver.contact_margin;
  query.first_node = state_.first_node;
  query.nodes.assign(state_.position.begin() + state_.first_node, state_.position.end());
  const std::vector<double>& radius = discretisation().radius;
  query.radius.assign(radius.begin() + state_.first_node, radius.end());
  return query;
}

double Simulation::surfacePenetration() const
{
  double deepest = 0.0;
  for (const contact::Feature& feature : stepper_->contactSet().features)
    deepest = std::max(deepest, -feature.gap);
  return deepest;
}

}  // namespace endovascular_sim::session
