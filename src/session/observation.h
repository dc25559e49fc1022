#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "procedure/branch_locator.h"
#include "session/world.h"
#include "simulation/contact_forces.h"
#include "simulation/hardware/sensors.h"
#include "simulation/simulation.h"

namespace endovascular_sim::session
{

/** Distal end of an instrument. */
struct Tip
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< patient frame; the introducer if the tip is outside [m]
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< columns tangent, d1, d2 of the material, patient frame
  double rotation = 0.0;  ///< of the material about the centreline, as that of the handle [rad]
};

/** Contrast medium after a step. */
struct ContrastState
{
  std::vector<double> cells;        ///< iodine in each cell of the vessel [kg/m³]; empty while there is none
  std::vector<double> instruments;  ///< iodine in the lumen of each instrument [kg/m³]; empty while there is none
  double rate = 0.0;                ///< present one of the injection [m³/s]
  double remaining = 0.0;           ///< of the present injection [m³]
  double syringe = 0.0;             ///< what it holds [m³]
  double volume = 0.0;              ///< injected since the beginning of the run [m³]
  flow::IodineTotals iodine;        ///< injected, inside the vessel, and left [kg]
};

/** Observation of a session after its last step. It copies nothing and computes a quantity when it is asked for.
 *
 *  References that it returns hold until the session's next step, reset or load. */
class Observation
{
public:
  /** The parameters belong to the session that owns the observation. */
  Observation(const simulation::Simulation& simulation, const World& world, const simulation::Sensors& sensors)
    : simulation_(simulation), world_(world), sensors_(sensors)
  {
  }

  std::uint64_t step() const { return simulation_.steps(); }  ///< number of steps so far
  double time() const { return simulation_.time(); }          ///< simulated time [s]
  int instruments() const { return simulation_.instruments(); }

  /** Position of an instrument's handle, force and torque on the hand, pressure. */
  simulation::HandState hand(int instrument) const { return simulation_.hand(instrument); }

  Tip tip(int instrument) const;

  /** Branch of an instrument's tip; −1 outside the vessel or the introducer. */
  procedure::BranchPosition branch(int instrument) const;

  /** Name of the branch of an instrument's tip; "outside" without one. */
  const std::string& branchName(int instrument) const { return world_.branches()->name(branch(instrument).branch); }

  /** Nodes of the common centreline, proximal to distal, patient frame [m]. Those before firstNode() lie behind the
   *  introducer's guide and are not simulated. */
  const std::vector<Eigen::Vector3d>& nodes() const { return simulation_.state().position; }
  int firstNode() const { return simulation_.state().first_node; }

  /** Features of the wall near the wire. */
  const contact::ContactSet& contacts() const { return simulation_.contactSet(); }

  /** Forces between wall and wire, one per touching node; computed by the first call after a step. */
  const std::vector<simulation::WallContact>& forces() const;

  /** Pressure at an instrument's opening through its line, relative to the air [Pa]; NaN without a line, and before the
   *  first step of the flow. */
  double pressure(int instrument) const;

  /** Pressure [Pa] and flow [m³/s] of the blood in the whole vessel; null in a scene without the key `flow`, and before
   *  the first step of the flow. */
  const flow::FlowField* blood() const;

  /** Flow of the blood at a point of the vessel, positive away from the heart [m³/s]; NaN as pressure().
   *  @param point patient frame [m] */
  double bloodFlow(const Eigen::Vector3d& point) const;

  /** Pressure of the blood at a point of the vessel [Pa]; NaN as pressure(). @param point patient frame [m] */
  double bloodPressure(const Eigen::Vector3d& point) const;

  /** Contrast medium; empty in a scene without the key `contrast`. */
  std::optional<ContrastState> contrast() const;

  /** Motion of the patient: phases, and the map from the resting patient to the moved one; null in a scene without the
   *  key `motion`. */
  const motion::MovingPatient* motion() const;

  /** Sensors of the scene: measured values beside the true ones of the other functions. */
  const simulation::Sensors& sensors() const { return sensors_; }

  const simulation::Simulation& simulation() const { return simulation_; }

  /** Events of balloons and stents so far. */
  const std::vector<simulation::TimedEvent>& events() const { return simulation_.events(); }

private:
  const simulation::Simulation& simulation_;
  const World& world_;
  const simulation::Sensors& sensors_;
  mutable std::vector<simulation::WallContact> forces_;
  mutable std::uint64_t forces_step_ = std::numeric_limits<std::uint64_t>::max();  ///< step that forces_ belong to
};

}  // namespace endovascular_sim::session
