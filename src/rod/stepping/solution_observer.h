#pragma once

#include <vector>

namespace endovascular_sim::rod
{

struct AcceptedPart;
struct Discretisation;
struct State;

/** Observer of the solutions that a scheme accepts, e.g. an energy audit. It changes neither scheme nor trajectory. */
class SolutionObserver
{
public:
  virtual ~SolutionObserver() = default;

  /** Least radii of the surface from now on, see Stepper::setContactRadii(). */
  virtual void setContactRadii(const std::vector<double>& radii) = 0;

  /** A step begins at a state. */
  virtual void beginStep(const Discretisation& rod, const State& state) = 0;

  /** A part of the step was accepted. */
  virtual void addPart(const AcceptedPart& part) = 0;

  /** The step ends. @param solved false: its parts are discarded, and the wire was stopped */
  virtual void endStep(bool solved) = 0;

  /** Work of the introducer's valve after a step, which is part of the force on the hand [J].
   *  @param push by insertion
   *  @param turn by rotation */
  virtual void addValve(double push, double turn) = 0;

  /** Work of a wall that has moved against the wire in a part [J]. */
  virtual void addMovedWall(double work) = 0;

  /** Keeps what was observed so far; revert() returns to it, any number of times, before steps are repeated. @{ */
  virtual void keep() = 0;
  virtual void revert() = 0;
  /** @} */
};

}  // namespace endovascular_sim::rod
