#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/phase_timer.h"
#include "rod/contact/wall_friction.h"
#include "rod/energy/potential_energy.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"
#include "rod/twist/surface_twist.h"
#include "rod/twist/twist_friction.h"

namespace endovascular_sim::rod
{

/** Action of the twist on the centreline. */
struct TwistAction
{
  bool active = false;
  int first_curved = 0;                            ///< first node with rest curvature
  const Eigen::Vector3d* rest_binormal = nullptr;  ///< rest curvature binormal per node from first_curved on [1]
  const double* torque = nullptr;                  ///< torque per node, summed over all layers [N·m]
};

/** Motion of a node's mass along the wire relative to the node, in a step. */
struct MassSlide
{
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();  ///< displacement [m]
  Eigen::Vector3d gained = Eigen::Vector3d::Zero();  ///< displacement less that at the last step's speed [m]
};

/** Motion of the layers over the nodes, which follow one of them, in a step. */
struct LayerSlides
{
  std::vector<Eigen::Vector3d> surface;  ///< displacement of the outer surface at every node [m]
  std::vector<MassSlide> mass;           ///< mean over the masses at every node
};

/** Slide of the outer surface over a node in a step [m]. @param slides null: none */
inline Eigen::Vector3d surfaceSlide(const LayerSlides* slides, int node)
{
  return slides != nullptr ? slides->surface[node] : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/** Energy that the friction between layers dissipates [J]. */
struct LayerFrictionWork
{
  double push = 0.0;  ///< along the wire
  double turn = 0.0;  ///< about the wire
};

/** Instruments on the centreline of a KktStepper: one wire (SingleLayer) or several, one inside the other (LayerStack).
 *
 *  The stepper solves for the centreline of one rod. A layer model provides the rod's properties, the twist, the motion
 *  of the material relative to the nodes, and the forces at the handles. */
class LayerModel
{
public:
  virtual ~LayerModel() = default;

  /** Length of a layer [m]. */
  virtual double length(int layer) const = 0;

  /** Straight layers at rest.
   *  @throws std::invalid_argument when there is not one input for every layer */
  virtual State initialState(const std::vector<LayerInput>& layers) const = 0;

  /** The same with the first layer inserted and all others outside. */
  virtual State initialState(double inserted_length, double rotation) const = 0;

  /** Checks the input of a step, and chooses the layer that the nodes follow.
   *  @return true when the nodes have moved, so that their contacts are no longer valid */
  virtual bool beginStep(State& state, const StepInput& input, double dt, WallFriction& friction) = 0;

  /** Input of the centreline: that of the layer that the nodes follow. Valid until the next call. */
  virtual const StepInput& centrelineInput(const State& state, const StepInput& input) = 0;

  /** Stops the layers after a rejected step. */
  virtual void stop(State& state) = 0;

  /** Moves the layers to their positions at the end of a step, or of a part of one, and updates the rod's properties.
   *  @return true when a handle turns */
  virtual bool advance(State& state, const StepInput& input, double dt) = 0;

  /** Computes the quasi-static twist for the present centreline.
   *  @param friction of the wall about the axis */
  virtual TwistAction relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                 PhaseTimer& timer) = 0;

  /** Computes or predicts the twist before a solve whose unknowns include the turns of the outer surface.
   *  @param friction of the wall about the axis; must outlive the solve
   *  @param first_solve the first one of the step */
  virtual TwistAction predictTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                                   bool first_solve, PhaseTimer& timer) = 0;

  /** True where rest curvature acts on the centreline. */
  virtual bool isCurved() const = 0;

  /** Linearises the twist that predictTwist() left. */
  virtual void lineariseTwist(const State& state, SurfaceTwist& twist) = 0;

  /** Turns the edges of the outer surface.
   *  @param turns per edge [rad]
   *  @param share factor on the turns */
  virtual void turnSurface(State& state, const std::vector<double>& turns, double share) = 0;

  /** Updates the torques at the ends for the present centreline; nothing else changes. */
  virtual void updateTorques(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                             PhaseTimer& timer) = 0;

  /** Angle of the outer surface at every node [rad]. */
  virtual void surfaceAngles(const State& state, std::vector<double>& angle) const = 0;

  /** Angle that the outer surface would have at every node of the present state if it had followed the edges since the
   *  beginning of the step without turning about them [rad]. */
  virtual void initialSurfaceAngles(const State& state, std::vector<double>& angle) const = 0;

  /** Turns of the Bishop frame of every edge since the beginning of the step [rad]; empty: neglected (FrameTurns). */
  virtual const std::vector<double>& frameTurns(const State& state) const = 0;

  /** First edge whose turn counts in frameTurns(); the largest integer where they are neglected. */
  virtual int firstCountedTurn() const = 0;

  /** Force that the rest curvature exerts along the wire where it begins to act, at the introducer's mouth, on the part
   *  inside the introducer: the derivative of the bending energy by the insertion of all layers at fixed nodes [N]. */
  virtual double restForce(const State& state) const = 0;

  /** Motion of the layers over the nodes in the step; null: none. */
  virtual const LayerSlides* slides() const = 0;

  /** Updates the handles' forces after a step that was solved. */
  virtual void finish(State& state, double dt) = 0;

  /** Upper bound of the handles' work between two states [J]. */
  virtual double handleWork(const State& before, const State& after) const = 0;

  /** Elastic energies of a state at rest. */
  virtual Energy energy(const State& state, const StepInput& input, WallFriction& friction) = 0;

  /** Adds bending and twist of a state at its present angles; see addElasticEnergy(). The rod's properties are then
   *  those of that state. */
  virtual void addElasticEnergy(const State& state, PotentialEnergy& energy) = 0;

  /** Work of the forces on the hands that belong to the change of the potentials at fixed nodes, in a part of a step:
   *  of layers that slide over the nodes, and of rest curvature that begins to act [J]. */
  virtual double insertionWork(const State& before, const State& after) const = 0;

  /** Work of the friction between layers in a part of a step. */
  virtual LayerFrictionWork frictionWork(const State& /*before*/, const State& /*after*/) const { return {}; }

  /** Takes over other nodes, which the rod already has. */
  virtual void resample() = 0;

  /** Restores the rod's properties for a loaded state. */
  virtual void restore(const State& state) = 0;
};

/** Friction of the wall about the axis for a state at rest. */
inline const std::vector<TwistFriction>& frictionAtRest(const LayerModel& layers, const Discretisation& rod,
                                                        const State& state, WallFriction& friction)
{
  std::vector<double> angle;
  layers.surfaceAngles(state, angle);
  const SurfaceMotion at_rest{rod.radius, angle, angle};
  friction.collect(state, state.position, nullptr, 1.0, false, &at_rest);
  return friction.aboutAxis();
}

}  // namespace endovascular_sim::rod
