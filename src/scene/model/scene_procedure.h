#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::scene
{

/** Action of one step of a procedure. */
enum class StepAction
{
  kAdvance,   ///< advance an instrument, with rotation at turn_speed
  kWithdraw,  ///< withdraw an instrument, with rotation at turn_speed
  kRotate,    ///< rotate an instrument in place
  kInflate,   ///< set the pressure of a balloon and wait; 0 deflates
  kExchange,  ///< withdraw one instrument completely, then advance another one
  kWait,      ///< wait for a duration
  kInject,    ///< inject contrast medium, until the injection has ended
};

/** Goal of a step. The step is complete when all given conditions hold. */
struct GoalScene
{
  std::string tip_in;      ///< branch that must contain the tip of the instrument; empty: no condition
  std::string balloon_in;  ///< branch that must contain the centre of the balloon; empty: no condition
  /** Minimum distance from the ostium along the branch, maximum while withdrawing [m]; NaN: no condition. */
  double beyond = std::numeric_limits<double>::quiet_NaN();
  bool outside = false;  ///< true: the instrument must have left the introducer
  /** Insertion to reach in the direction of the step [m]; NaN: no condition. */
  double insertion = std::numeric_limits<double>::quiet_NaN();
  /** Displacement of the handle since the start of the step [m]; NaN: no condition. */
  double by = std::numeric_limits<double>::quiet_NaN();
  /** Signed rotation of the handle since the start of the step [rad]; NaN: no condition. */
  double turned = std::numeric_limits<double>::quiet_NaN();
  double held = 0.0;  ///< duration for which the other conditions must hold [s]
};

/** Recovery of an instrument that makes no progress or enters a wrong branch: pull back, rotate, retry. */
struct RetryScene
{
  double back = 0.01;  ///< distance to pull back [m]
  double turn = 1.0;   ///< rotation about the axis of the instrument [rad]
  int times = 5;       ///< largest number of retries
  /** Insertion beyond which the goal counts as missed and the step is retried [m]; NaN: no limit. */
  double deepest = std::numeric_limits<double>::quiet_NaN();
};

/** Support of an advancing instrument by an outer one, e.g. by a guiding catheter in an ostium.
 *
 *  If the support is lost, the operator withdraws the instrument and resumes from an earlier phase. */
struct SupportScene
{
  std::string instrument;  ///< supporting instrument; empty: none
  std::string tip_in;      ///< branch at or beyond which the tip of either of the two instruments must be
  std::string again_from;  ///< phase to resume from after a loss of support
  int times = 3;           ///< number of losses after which the procedure fails
};

/** One step of a procedure. */
struct StepScene
{
  std::string phase;  ///< name of the phase for reports; empty: phase of the previous step
  std::string hint;   ///< advice to a person who does the step; empty: none
  std::string view;   ///< view of the C-arm (fluoroscopy/gantry/view.h); empty: view of the previous step
  StepAction action = StepAction::kWait;
  std::string instrument;   ///< moved instrument; in an exchange, the withdrawn one; the one that injects
  std::string replacement;  ///< instrument that an exchange advances
  GoalScene until;
  double speed = 0.02;      ///< insertion speed [m/s]
  double turn_speed = 0.0;  ///< rotation speed [rad/s]
  bool steer = false;       ///< true: near junctions the operator turns the bent tip along the path to the goal
  double pressure = 0.0;    ///< pressure of an inflation [Pa]
  double duration = 0.0;    ///< duration of an inflation or a wait [s]
  /** Hyperaemia required during a wait; empty: any. The scripted operator sets it. For a person the wait counts while
   * it is set. */
  std::optional<bool> hyperaemia;
  /** Breath-hold of a wait, true: held; empty: any. The scripted operator asks for it when the wait begins, and waits
   * until the breath is held. For a person the wait counts while it is set. */
  std::optional<bool> breath_held;
  double volume = 0.0;          ///< of an injection [m³]
  double rate = 0.0;            ///< of an injection, after the rise [m³/s]
  double rise = 0.3;            ///< of the rate of an injection [s]
  bool until_diastole = false;  ///< true: a wait ends in a diastole
  double time_limit = 30.0;     ///< duration after which the step fails [s]
  bool any_branch = false;      ///< true: no branch counts as wrong
  RetryScene retry;
  SupportScene support;
};

/** Limits of the operator's motion and perception. */
struct HandScene
{
  double max_speed = 0.05;          ///< largest insertion speed [m/s]
  double max_turn = 6.0;            ///< largest rotation speed [rad/s]
  double acceleration = 0.2;        ///< acceleration of the insertion [m/s²]
  double turn_acceleration = 20.0;  ///< acceleration of the rotation [rad/s²]
  double reaction = 0.05;           ///< period of the observations [s]
  double push_force = 2.0;          ///< force at which the operator stops pushing [N]
  double pull_force = 3.0;          ///< force at which the operator stops pulling [N]
  double patience = 1.5;            ///< time without progress after which the operator retries [s]
  double speed_scale = 1.0;         ///< factor on all speeds of the steps [1]
};

/** Name for the branch nearest to a point, for vessels without meaningful branch names. */
struct NamedBranch
{
  std::string name;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< point in the branch, patient frame [m]
};

/** Pass marks of a lesson: largest values of metrics of the session. NaN: not marked. */
struct PassMarks
{
  double time = std::numeric_limits<double>::quiet_NaN();            ///< from the first motion [s]
  double wall_force = std::numeric_limits<double>::quiet_NaN();      ///< largest force of one contact on the wall [N]
  double hand_force = std::numeric_limits<double>::quiet_NaN();      ///< largest force on a handle [N]
  double wrong_branches = std::numeric_limits<double>::quiet_NaN();  ///< entries of wrong branches [1]
  double errors = std::numeric_limits<double>::quiet_NaN();          ///< errors of the trainee [1]
  double stenosis = std::numeric_limits<double>::quiet_NaN();  ///< of every lesion by its diameter, at the end [1]
};

/** Procedure of a scripted operator, or, in a lesson, of a person. */
struct ProcedureScene
{
  std::string name;
  bool guided = false;  ///< true: a person does the steps; the operator observes their goals only
  PassMarks pass;
  HandScene hand;
  std::vector<NamedBranch> branches;
  std::vector<StepScene> steps;
};

}  // namespace endovascular_sim::scene
