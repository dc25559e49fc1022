#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::scene
{

/** What one step of a procedure does. */
enum class StepAction
{
  kAdvance,   ///< pushes an instrument, turning it where turn_speed says so
  kWithdraw,  ///< draws it back
  kRotate,    ///< turns it in place
  kInflate,   ///< sets its balloon's pressure and waits; 0 deflates
  kExchange,  ///< draws one instrument out, then pushes another one in
  kWait,
};

/** When a step is done: every condition that is given holds. */
struct GoalScene
{
  std::string tip_in;      ///< branch that holds the instrument's tip; empty: not asked
  std::string balloon_in;  ///< branch that holds the middle of its balloon; empty: not asked
  double beyond = std::numeric_limits<double>::quiet_NaN();     ///< at least so far from the ostium; NaN: anywhere [m]
  bool outside = false;                                         ///< the instrument has left the introducer
  double insertion = std::numeric_limits<double>::quiet_NaN();  ///< reached, in the step's direction [m]
  double by = std::numeric_limits<double>::quiet_NaN();         ///< moved at the hand since the step began [m]
  double turned = std::numeric_limits<double>::quiet_NaN();     ///< since the step began, with its sign [rad]
  double held = 0.0;                                            ///< for which the goal must hold [s]
};

/** What a person does when an instrument makes no way or enters a wrong branch: pull back, turn, try again. */
struct RetryScene
{
  double back = 0.01;  ///< [m]
  double turn = 1.0;   ///< about the instrument's axis [rad]
  int times = 5;
  /** Insertion beyond which he has missed the goal and tries again; NaN: none [m]. */
  double deepest = std::numeric_limits<double>::quiet_NaN();
};

/** What leads a step's instrument to its way, as a guide in its ostium; and what a person does when the instrument
 * comes out of it elsewhere: draws it back and goes on from an earlier phase. */
struct SupportScene
{
  std::string instrument;  ///< that supports; empty: nothing is asked
  std::string tip_in;      ///< branch in which its tip or that of the step's instrument has to be, or beyond
  std::string again_from;  ///< phase
  int times = 3;           ///< then the procedure has failed
};

/** One step of a procedure. */
struct StepScene
{
  std::string phase;  ///< what it is for, in words
  StepAction action = StepAction::kWait;
  std::string instrument;   ///< that it moves; of an exchange: that comes out
  std::string replacement;  ///< of an exchange: that goes in
  GoalScene until;
  double speed = 0.02;       ///< [m/s]
  double turn_speed = 0.0;   ///< while it advances, or of a rotation [rad/s]
  double pressure = 0.0;     ///< of an inflation [Pa]
  double duration = 0.0;     ///< of an inflation or a wait [s]
  double time_limit = 30.0;  ///< then the step has failed [s]
  bool any_branch = false;   ///< branches that do not lead to the goal are not left again
  RetryScene retry;
  SupportScene support;
};

/** What the operator's hands and eyes can do. */
struct HandScene
{
  double max_speed = 0.05;          ///< [m/s]
  double max_turn = 6.0;            ///< [rad/s]
  double acceleration = 0.2;        ///< [m/s²]
  double turn_acceleration = 20.0;  ///< [rad/s²]
  double reaction = 0.05;           ///< between two looks [s]
  double push_force = 2.0;          ///< at which he stops pushing [N]
  double pull_force = 3.0;          ///< at which he stops pulling [N]
  double patience = 1.5;            ///< without progress, before he tries again [s]
  double speed_scale = 1.0;         ///< on every speed of the steps [1]
};

/** A name for the branch that is nearest to a point, where the vessel's own names say nothing. */
struct NamedBranch
{
  std::string name;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< patient frame, in the branch [m]
};

/** What a scripted operator does, and how. */
struct ProcedureScene
{
  std::string name;
  HandScene hand;
  std::vector<NamedBranch> branches;
  std::vector<StepScene> steps;
};

}  // namespace endovascular_sim::scene
