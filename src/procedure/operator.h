#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/archive.h"
#include "procedure/branch_places.h"
#include "procedure/observation.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{

enum class Progress
{
  kRunning,
  kDone,
  kFailed,
  kLost,  ///< of a step: the instrument has come out of its support elsewhere, and he goes back to an earlier one
};

/** How one step of the procedure went. */
struct StepRecord
{
  std::string name;        ///< e.g. "advance wire until its tip is in aortic_arch"
  std::string phase;       ///< as the procedure calls it
  double begin = 0.0;      ///< [s]
  double end = 0.0;        ///< [s]; of the running step, the newest look
  int retries = 0;         ///< after no progress
  int wrong_branches = 0;  ///< entered and left again
  Progress outcome = Progress::kRunning;
  std::size_t step = 0;  ///< of the procedure, an exchange counted as two
};

/** A scripted person at the hands of all instruments: sees the tips and feels the hands' forces at his reaction
 *  interval, moves one instrument at a time within the limits of his hands, and goes through the steps of the scene's
 *  procedure. The same observations give the same commands, bit for bit.
 *
 *  Without progress, and from a branch that does not lead to the goal, he pulls back, turns and tries again. Where the
 *  instrument has come out of its support elsewhere, he draws it back and goes on from an earlier step. */
class Operator
{
public:
  /** @param scene with a procedure
   *  @param tree the centreline of its vessel
   *  @param entry the introducer
   *  @throws InputError for a branch that the vessel does not have, naming those that it has */
  Operator(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry);

  /** Commands for the simulation's next step, one per instrument; those that the procedure does not drive follow their
   *  drives. To be called once before every step. */
  const std::vector<simulation::HandCommand>& next(const simulation::Simulation& simulation);

  /** Parts of next(), for observations from elsewhere. @{ */
  bool looksBefore(std::uint64_t step) const { return step % look_every_ == 0; }
  void see(const Observation& seen);
  const std::vector<simulation::HandCommand>& move(double end_time);
  /** @} */

  Progress progress() const { return progress_; }
  /** Why it failed: step, reason, where the tip is; empty otherwise. */
  const std::string& failure() const { return failure_; }
  const std::vector<StepRecord>& records() const { return records_; }  ///< of the steps that have begun
  const BranchPlaces& places() const { return places_; }
  int enteredBranch() const { return entered_; }  ///< in which the introducer sits

  /** Saves or loads all that changes. */
  void archive(Archive& archive);

private:
  /** What he does within a step. */
  enum class Mode
  {
    kGo,      ///< the step itself
    kLeave,   ///< out of a wrong branch
    kBack,    ///< a little further
    kTurn,    ///< before he tries again
    kReturn,  ///< into what supported it, before he goes on from an earlier step
  };

  struct Hand
  {
    double insertion = 0.0, rotation = 0.0;  ///< commanded [m], [rad]
    double speed = 0.0, turn_speed = 0.0;    ///< now [m/s], [rad/s]
    double wanted = 0.0, wanted_turn = 0.0;  ///< that he accelerates to
    double pressure = 0.0;                   ///< [Pa]
    void archive(Archive& archive) { archive(insertion, rotation, speed, turn_speed, wanted, wanted_turn, pressure); }
    bool scripted = false;  ///< driven by the procedure
  };

  void expand();
  void checkBranches() const;
  void begin(const Observation& seen);
  void prepareStep();
  void archiveRecords(Archive& archive);
  void act(const Observation& seen);
  void go(const InstrumentView& view);
  void manoeuvre(const InstrumentView& view, double time);
  bool isReached(const Observation& seen) const;
  bool isInPlace(const InstrumentView& view) const;
  bool missesSupport(const Observation& seen);
  void comeBack(const Observation& seen);
  void giveUp(const InstrumentView& view, double time);
  bool stalls(const InstrumentView& view, double time);
  bool tryAgain(Mode mode, const InstrumentView& view, const std::string& why);
  void fail(const InstrumentView* view, const std::string& why);
  void finishStep(double time);
  void rest();
  double pushed(const InstrumentView& view, double speed) const;
  const scene::StepScene& step() const { return steps_[current_]; }
  std::string nameOf(const scene::StepScene& step) const;

  scene::Scene scene_;
  scene::HandScene hand_;
  BranchPlaces places_;
  int entered_ = -1;
  std::uint64_t look_every_ = 1;
  std::vector<scene::StepScene> steps_;  ///< with every exchange as two
  std::vector<Hand> hands_;
  std::vector<simulation::HandCommand> commands_;
  std::vector<StepRecord> records_;
  std::size_t current_ = 0;
  bool begun_ = false;
  Progress progress_ = Progress::kRunning;
  std::string failure_;

  // Of the current step:
  int active_ = -1;  ///< instrument
  int goal_branch_ = -1;
  std::vector<bool> on_way_;  ///< of every branch
  int support_ = -1;          ///< instrument; −1: none is asked for
  int support_branch_ = -1;
  Mode mode_ = Mode::kGo;
  double begin_time_ = 0.0, begin_insertion_ = 0.0, begin_rotation_ = 0.0;
  double reached_since_ = -1.0;                            ///< negative: not reached [s]
  double lost_since_ = -1.0;                               ///< the support; negative: it is in its place [s]
  double progress_time_ = 0.0, progress_insertion_ = 0.0;  ///< of the last progress
  Eigen::Vector3d progress_tip_ = Eigen::Vector3d::Zero();
  double mode_insertion_ = 0.0, mode_rotation_ = 0.0, mode_time_ = 0.0;  ///< where the manoeuvre began
};

}  // namespace endovascular_sim::procedure
