#include "rod/contact/wall_friction.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSticking = 0.99;       // square of the stretch of a node that sticks, over that of the slip
constexpr double kLeastForce = 1e-9;     // N: smaller wall forces have no friction
constexpr double kLeastArm = 1e-9;       // m/rad: where a wire stands on the wall, friction does not act on its twist
constexpr double kTolerance = 0.1;       // deviation from Coulomb's law, share of the sum of all limits
constexpr double kNodeTolerance = 0.01;  // deviation of a node, share of its limit
// Weight of the inertia: large enough for inertia to outweigh friction, small enough for an accurate first pass.
constexpr double kInertiaWeight = 16.0;
constexpr int kSecantFromPass = 1;  // from this pass on, secants only: they dissipate energy
constexpr int kLastPass = 3;
// The same for solves whose unknowns include the turns.
constexpr double kToleranceWithTurns = 0.01;
constexpr double kNodeToleranceWithTurns = 0.001;
constexpr int kLastPassWithTurns = 12;

Vector3d tangential(const Vector3d& vector, const Vector3d& normal)
{
  return vector - normal.dot(vector) * normal;
}

/** Motion of the wire's surface over the wall per turn of a node about its axis [m/rad]. */
Vector3d motionPerTurn(const State& state, int node, const Vector3d& normal, double radius)
{
  const int before = std::max(node - 1, state.first_node);
  const int after = std::min(node + 1, static_cast<int>(state.position.size()) - 1);
  return radius * normal.cross((state.position[after] - state.position[before]).normalized());
}

/** Motion of the wall at a node [m]. */
Vector3d wallTravel(const SurfaceMotion* surface, int node)
{
  return surface != nullptr && surface->wall != nullptr ? surface->wall->displacement[node]
                                                        : Vector3d(Vector3d::Zero());
}

/** Turn of the wall about the wire's axis at a node [rad]. */
double wallTurn(const SurfaceMotion& surface, int node)
{
  return surface.wall_turn != nullptr ? (*surface.wall_turn)[node] : 0.0;
}

}  // namespace

double nodeAngle(const std::vector<double>& twist_angle, int node, int first_node)
{
  const int last = static_cast<int>(twist_angle.size()) - 1;
  return 0.5 * (twist_angle[std::max(node - 1, first_node)] + twist_angle[std::min(node, last)]);
}

void WallFriction::collect(const State& state, const Motion& begin, const std::vector<double>* mass, double dt,
                           bool first_solve, const SurfaceMotion* surface)
{
  contacts_.clear();
  contacts_.reserve(state.position.size());
  for (int i = state.first_node; i < static_cast<int>(state.position.size()); ++i)
  {
    if (state.wall_force[i].isZero(0.0) || state.friction_coefficient[i] <= 0.0)
      continue;
    const double normal_force = state.wall_force[i].norm();
    if (normal_force < kLeastForce)
      continue;
    Contact contact;
    contact.node = i;
    contact.limit = state.friction_coefficient[i] * normal_force;
    contact.normal = state.wall_force[i] / normal_force;
    Vector3d dragged = state.friction_stretch[i];
    if (surface != nullptr && surface->slide != nullptr)
      dragged += (*surface->slide)[i];
    if (surface != nullptr && surface->wall != nullptr)
      dragged -= wallTravel(surface, i);
    const Vector3d travel = state.position[i] - begin[i];
    contact.stretch = tangential(dragged + travel, contact.normal);
    contact.dual = tangential(state.friction_stretch[i], contact.normal) / slip_;
    contact.guess = contact.stretch;
    // A node that sticks to a wall whose velocity changes keeps sticking: its own velocity is that of the wall before.
    const bool sticks = surface != nullptr && surface->wall != nullptr &&
                        state.friction_stretch[i].squaredNorm() < kSticking * slip_ * slip_;
    if (first_solve && !sticks)
      contact.guess = tangential(dragged + dt * state.velocity[i], contact.normal);
    contact.inertia = mass != nullptr ? (*mass)[i] / (dt * dt) : 0.0;
    if (surface != nullptr)
    {
      contact.around = motionPerTurn(state, i, contact.normal, surface->radius[i]);
      contact.begin_angle = surface->begin_angle[i] + wallTurn(*surface, i);
    }
    contacts_.push_back(contact);
  }
}

const std::vector<TwistFriction>& WallFriction::aboutAxis()
{
  about_axis_.clear();
  about_axis_.reserve(contacts_.capacity());
  for (const Contact& contact : contacts_)
  {
    TwistFriction friction;
    friction.arm = contact.around.norm();
    if (friction.arm <= kLeastArm)
      continue;
    friction.node = contact.node;
    friction.limit = contact.limit;
    friction.slip = slip_;
    // The lateral motion of a rolling wire follows from its rotation. A predicted lateral motion would cancel the
    // friction in both positions and twist. Therefore the stretch of the present iterate is used about the axis.
    friction.along = contact.stretch.dot(contact.around) / friction.arm;
    const double guessed = contact.guess.dot(contact.around) / friction.arm;
    friction.across_squared = std::max(0.0, contact.guess.squaredNorm() - guessed * guessed);
    friction.begin_angle = contact.begin_angle;
    about_axis_.push_back(friction);
  }
  return about_axis_;
}

void WallFriction::linearise(const SurfaceMotion* surface)
{
  terms_.resize(contacts_.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    linearise(k, contacts_[k].guess + beginTerm(k, surface), kInertiaWeight);
}

/** Begins the term of a node, and adds the rotation of its surface to the stretch.
 *  @return motion of the surface by its rotation so far [m] */
Vector3d WallFriction::beginTerm(std::size_t index, const SurfaceMotion* surface)
{
  Contact& contact = contacts_[index];
  Term& term = terms_[index];
  Vector3d turned = Vector3d::Zero();
  if (!contact.around.isZero(0.0))
    turned = (surface->angle[contact.node] - contact.begin_angle) * contact.around;
  contact.stretch += turned;
  term.node = contact.node;
  term.turned.setZero();
  return turned;
}

void WallFriction::linearise(std::size_t index, const Vector3d& stretch, double inertia_weight)
{
  const Contact& contact = contacts_[index];
  Term& term = terms_[index];
  const double length = stretch.norm();
  const double secant = law(contact).secant(length);
  term.stiffness = secant * (Matrix3d::Identity() - contact.normal * contact.normal.transpose());
  term.pull = secant * contact.stretch;
  if (length <= slip_)
    return;
  const Vector3d direction = stretch / length;
  const double lowered = std::min(secant, inertia_weight * contact.inertia);
  term.stiffness -= lowered * direction * direction.transpose();
  term.pull += (lowered * direction.dot(stretch - contact.stretch)) * direction;
}

void WallFriction::lineariseWithTurns(const SurfaceMotion& surface)
{
  terms_.resize(contacts_.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k)
  {
    terms_[k].around = contacts_[k].around;
    lineariseAtDual(k, contacts_[k].guess + beginTerm(k, &surface));
  }
}

/** Linearises a node at a stretch and the pull of the preceding pass. */
void WallFriction::lineariseAtDual(std::size_t index, const Vector3d& stretch)
{
  const Contact& contact = contacts_[index];
  Term& term = terms_[index];
  const double length = stretch.norm();
  const double secant = law(contact).secant(length);
  term.stiffness = secant * (Matrix3d::Identity() - contact.normal * contact.normal.transpose());
  if (length > slip_)
  {
    const Vector3d direction = stretch / length;
    const Vector3d dual = contact.dual / std::max(1.0, contact.dual.norm());
    term.stiffness -= (0.5 * secant) * (dual * direction.transpose() + direction * dual.transpose());
  }
  term.pull = secant * stretch + term.stiffness * (contact.stretch - stretch);
}

bool WallFriction::updateWithTurns(const Motion& motion, const std::vector<double>& turn, int pass)
{
  double whole = 0.0;
  double wrong = 0.0;
  for (std::size_t k = 0; k < terms_.size(); ++k)
  {
    Term& term = terms_[k];
    Contact& contact = contacts_[k];
    term.turned = turn[term.node] * contact.around;
    const Vector3d stretch = contact.stretch + tangential(motion[term.node] + term.turned, contact.normal);
    whole += contact.limit;
    wrong += (term.pullAfter(motion[term.node]) - force(k, stretch)).norm();
  }
  if (wrong <= kToleranceWithTurns * whole || pass > kLastPassWithTurns)
    return false;
  first_changed_ = std::numeric_limits<int>::max();
  for (std::size_t k = 0; k < terms_.size(); ++k)
  {
    const Term& term = terms_[k];
    Contact& contact = contacts_[k];
    const Vector3d stretch = contact.stretch + tangential(motion[term.node] + term.turned, contact.normal);
    const Vector3d pull = term.pullAfter(motion[term.node]);
    contact.dual = pull / contact.limit;
    if ((pull - force(k, stretch)).norm() <= kNodeToleranceWithTurns * contact.limit)
      continue;
    lineariseAtDual(k, stretch);
    first_changed_ = std::min(first_changed_, term.node);
  }
  return true;
}

/** Friction by Coulomb's law at a stretch [N]. */
Vector3d WallFriction::force(std::size_t index, const Vector3d& stretch) const
{
  return law(contacts_[index]).secant(stretch.norm()) * stretch;
}

bool WallFriction::update(const Motion& motion, int pass)
{
  if (pass > kLastPass)
    return false;
  double whole = 0.0;
  double wrong = 0.0;
  for (std::size_t k = 0; k < terms_.size(); ++k)
  {
    const Term& term = terms_[k];
    const Vector3d stretch = contacts_[k].stretch + tangential(motion[term.node], contacts_[k].normal);
    whole += contacts_[k].limit;
    wrong += (term.pull + term.stiffness * motion[term.node] - force(k, stretch)).norm();
  }
  if (wrong <= kTolerance * whole)
    return false;
  first_changed_ = std::numeric_limits<int>::max();
  for (std::size_t k = 0; k < terms_.size(); ++k)
  {
    const Term& term = terms_[k];
    const Vector3d stretch = contacts_[k].stretch + tangential(motion[term.node], contacts_[k].normal);
    const Vector3d error = term.pull + term.stiffness * motion[term.node] - force(k, stretch);
    if (error.norm() <= kNodeTolerance * contacts_[k].limit)
      continue;
    linearise(k, stretch, pass < kSecantFromPass ? kInertiaWeight : 0.0);
    first_changed_ = std::min(first_changed_, term.node);
  }
  return true;
}

void WallFriction::finish(State& state, const Motion& begin, const SurfaceMotion* surface) const
{
  for (int i = state.first_node; i < static_cast<int>(state.position.size()); ++i)
  {
    Vector3d& stretch = state.friction_stretch[i];
    if (state.wall_force[i].isZero(0.0))
    {
      stretch.setZero();
      continue;
    }
    const Vector3d normal = state.wall_force[i].normalized();
    if (surface != nullptr && surface->slide != nullptr)
      stretch += (*surface->slide)[i];
    if (surface != nullptr && surface->wall != nullptr)
      stretch -= wallTravel(surface, i);
    stretch = tangential(stretch + state.position[i] - begin[i], normal);
    if (surface != nullptr)
    {
      const double angle = surface->angle[i] - surface->begin_angle[i] - wallTurn(*surface, i);
      if (angle != 0.0)
        stretch += angle * motionPerTurn(state, i, normal, surface->radius[i]);
    }
    CoulombLaw{0.0, slip_}.cut(stretch);
  }
}

Vector3d frictionForce(const State& state, int node, double slip)
{
  const CoulombLaw law{state.friction_coefficient[node] * state.wall_force[node].norm(), slip};
  return -law.tangent(0.0) * state.friction_stretch[node];
}

}  // namespace endovascular_sim::rod
