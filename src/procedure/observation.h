#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "procedure/branch_locator.h"
#include "procedure/steering.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{

/** Observable state of one instrument. Points lie in the vessel at rest, also where the patient moves: goals, branches
 *  and lengths of paths do not contain the motion of the heart. */
struct InstrumentView
{
  simulation::HandState hand;
  bool outside = false;                           ///< true if the instrument has left the introducer
  bool covered = false;                           ///< true if the tip lies inside another instrument
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< place at rest; the introducer if outside [m]
  double tip_rotation = 0.0;                      ///< rotation of the material at the tip, as that of the handle [rad]
  BranchPosition branch_position;                 ///< position of the tip in the tree of branches
  TipBend bend;                                   ///< bend of the tip; straight if outside
  std::optional<Eigen::Vector3d> balloon;         ///< centre of the balloon if it is in the vessel, at rest [m]
};

/** Observable beat of the heart. */
struct HeartView
{
  double rate = 0.0;     ///< of the present beat; 0: the heart does not move [Hz]
  double phase = 0.0;    ///< of the beat, 0 at end-diastole [1]
  double systole = 0.0;  ///< share of the beat from end-diastole to end-systole [1]
};

/** Observation of the scripted operator at one time. */
struct Observation
{
  double time = 0.0;  ///< simulated time [s]
  std::vector<InstrumentView> instruments;
  bool hyperaemia = false;     ///< of the circulation; false without flow
  bool patient_moves = false;  ///< false: nobody needs to wait for breath or heart
  bool breath_asked = false;   ///< true: the patient is asked to hold the breath; false without motion
  bool breath_held = false;    ///< true: the breath is held, at the end of an expiration; false without motion
  HeartView heart;
  bool is_injecting = false;     ///< contrast medium is injected; false in a scene without
  double injected_volume = 0.0;  ///< of contrast medium since the beginning of the run [m³]
};

/** Length from the tip of an instrument to the proximal end of its foremost curve; 0 for a straight instrument [m]. */
double bentLength(const instrument::Instrument& instrument);

/** Sets InstrumentView::covered from the insertions. */
void markCovered(Observation& observation);

/** Observes a simulation, without the branches of the tips. */
Observation observe(const scene::Scene& scene, const simulation::Simulation& simulation);

/** Sets the branches of all tips in the vessel. */
void locate(Observation& observation, const BranchLocator& locator);

/** Observes a simulation. */
Observation observe(const scene::Scene& scene, const simulation::Simulation& simulation, const BranchLocator& locator);

}  // namespace endovascular_sim::procedure
