#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "nodes/rod_dynamics/control/pace.h"
#include "nodes/rod_dynamics/control/recorder_progress.h"
#include "nodes/rod_dynamics/graph_simulation.h"

namespace endovascular_sim::nodes
{

/** Reasons for which no step can be taken: a pause, a lost node of contact or flow, a recorder that lags behind. */
class StepObstacles
{
public:
  /** @param simulation, recorder must outlive this object
   *  @param pause_after silence of the node of contact or flow that causes a pause in real time [s]
   *  @param is_over true when the simulation ends, which ends every wait */
  StepObstacles(GraphSimulation& simulation, RecorderProgress& recorder, Pace pace, double pause_after,
                std::function<bool()> is_over);

  void setPaused(bool is_paused) { is_paused_ = is_paused; }  ///< by a client
  bool isPaused() const { return is_paused_; }

  /** Looks for a reason, and queries a lost node again. A brief lag of the recorder, or of the flow, is waited for.
   *  @param is_held true while no step is taken
   *  @return empty without a reason */
  std::string find(bool is_held);

  /** Reports whether a reason is the loss of another node. */
  static bool isFault(const std::string& reason);

  /** Reports whether the last call of find() has waited for the first flow of a run, whose computation takes some
   * steps.
   */
  bool hasWaitedForFirstFlow() const { return has_waited_; }

private:
  bool isContactSilent() const;
  bool isContactMissing();
  bool isFlowMissing(bool is_held);
  bool isRecorderBehind(bool is_held);

  GraphSimulation& simulation_;
  RecorderProgress& recorder_;
  Pace pace_;
  double pause_after_;
  std::function<bool()> is_over_;
  bool is_paused_ = false;
  bool has_waited_ = false;
  bool is_listening_ = false;  ///< for a response of the contact node
};

}  // namespace endovascular_sim::nodes
