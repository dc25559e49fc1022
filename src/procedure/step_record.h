#pragma once

#include <cstddef>
#include <string>

#include "scene/model/scene_procedure.h"

namespace endovascular_sim::procedure
{

/** State of a procedure or of one step. */
enum class Progress
{
  kRunning,
  kDone,
  kFailed,
  kSupportLost,  ///< the step lost its support, and the procedure resumes from an earlier step
};

/** Record of one step of the procedure. */
struct StepRecord
{
  std::string name;        ///< description, e.g. "advance wire until its tip is in aortic_arch"
  std::string phase;       ///< phase of the procedure
  std::string view;        ///< view of the C-arm; empty: that of the scene
  double begin = 0.0;      ///< start time [s]
  double end = 0.0;        ///< end time; the latest observation while the step runs [s]
  int retries = 0;         ///< number of retries
  int wrong_branches = 0;  ///< number of entries into wrong branches, see BranchEntries
  Progress outcome = Progress::kRunning;
  std::size_t step = 0;  ///< index of the step in the procedure, an exchange counted as two
  std::string hint;      ///< advice to a person; empty: none
};

/** Description of a step, as StepRecord::name. */
std::string nameOf(const scene::StepScene& step);

}  // namespace endovascular_sim::procedure
