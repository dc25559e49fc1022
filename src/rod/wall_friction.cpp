#include "rod/wall_friction.h"

#include <algorithm>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastForce = 1e-9;     // N: a wall force below it has no friction
constexpr double kTolerance = 0.1;       // of the sum of all limits, by which friction may be wrong
constexpr double kNodeTolerance = 0.01;  // of a node's limit: the node is left as it is
// Inertia so many times over may outweigh a node's friction and is still enough to keep the first pass near the mark.
constexpr double kInertiaWeight = 16.0;
constexpr int kSecantFromPass = 1;  // secants only take energy
constexpr int kLastPass = 3;

Vector3d tangential(const Vector3d& vector, const Vector3d& normal)
{
  return vector - normal.dot(vector) * normal;
}

}  // namespace

void WallFriction::prepare(const State& state, const Motion& begin, const std::vector<double>* mass, double dt,
                           bool first_solve)
{
  contacts_.clear();
  terms_.clear();
  contacts_.reserve(state.position.size());
  terms_.reserve(state.position.size());
  for (int i = state.first_node; i < static_cast<int>(state.position.size()); ++i)
  {
    if (state.wall_force[i].isZero(0.0) || state.friction_coefficient[i] <= 0.0)
      continue;
    const double normal_force = state.wall_force[i].norm();
    if (normal_force < kLeastForce)
      continue;
    Contact contact;
    contact.limit = state.friction_coefficient[i] * normal_force;
    contact.normal = state.wall_force[i] / normal_force;
    const Vector3d travel = state.position[i] - begin[i];
    contact.stretch = tangential(state.friction_stretch[i] + travel, contact.normal);
    Vector3d guess = contact.stretch;
    if (first_solve)
      guess = tangential(state.friction_stretch[i] + dt * state.velocity[i], contact.normal);
    contact.inertia = mass != nullptr ? (*mass)[i] / (dt * dt) : 0.0;
    contacts_.push_back(contact);
    terms_.emplace_back();
    terms_.back().node = i;
    linearise(terms_.size() - 1, guess, kInertiaWeight);
  }
}

void WallFriction::linearise(std::size_t index, const Vector3d& stretch, double inertia_weight)
{
  const Contact& contact = contacts_[index];
  Term& term = terms_[index];
  const double length = stretch.norm();
  const double secant = contact.limit / std::max(length, slip_);
  term.stiffness = secant * (Matrix3d::Identity() - contact.normal * contact.normal.transpose());
  term.pull = secant * contact.stretch;
  if (length <= slip_)
    return;
  const Vector3d direction = stretch / length;
  const double lowered = std::min(secant, inertia_weight * contact.inertia);
  term.stiffness -= lowered * direction * direction.transpose();
  term.pull += (lowered * direction.dot(stretch - contact.stretch)) * direction;
}

/** Coulomb's law at a stretch. */
Vector3d WallFriction::force(std::size_t index, const Vector3d& stretch) const
{
  return (contacts_[index].limit / std::max(stretch.norm(), slip_)) * stretch;
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
  for (std::size_t k = 0; k < terms_.size(); ++k)
  {
    const Term& term = terms_[k];
    const Vector3d stretch = contacts_[k].stretch + tangential(motion[term.node], contacts_[k].normal);
    const Vector3d error = term.pull + term.stiffness * motion[term.node] - force(k, stretch);
    if (error.norm() > kNodeTolerance * contacts_[k].limit)
      linearise(k, stretch, pass < kSecantFromPass ? kInertiaWeight : 0.0);
  }
  return true;
}

void WallFriction::finish(State& state, const Motion& begin) const
{
  for (std::size_t i = static_cast<std::size_t>(state.first_node); i < state.position.size(); ++i)
  {
    Vector3d& stretch = state.friction_stretch[i];
    if (state.wall_force[i].isZero(0.0))
    {
      stretch.setZero();
      continue;
    }
    stretch = tangential(stretch + state.position[i] - begin[i], state.wall_force[i].normalized());
    const double length = stretch.norm();
    if (length > slip_)
      stretch *= slip_ / length;
  }
}

Vector3d frictionForce(const State& state, int node, double slip)
{
  return -(state.friction_coefficient[node] * state.wall_force[node].norm() / slip) * state.friction_stretch[node];
}

}  // namespace endovascular_sim::rod
