#pragma once

#include <string>
#include <vector>

#include "nodes/runtime/processor/processor_choice.h"

namespace endovascular_sim::nodes
{

/** Processors that the calling thread may use, ascending; empty on failure. */
std::vector<int> allowedProcessors();

/** Folder of the claims of all sessions of a machine. */
constexpr auto kClaimFolder = "/dev/shm/endovascular_sim";

/** Claim of a session on the processor of its real-time nodes, visible to all sessions of the machine.
 *
 *  A claim is a file `PROCESSOR-SESSION` in a shared folder, on which every process of the session holds a shared lock
 *  (flock). The kernel releases the lock with the process. A file without a lock belongs to a session that has ended
 *  and is removed. The first process of a session chooses the processor, the others join. Any account may hold the
 *  folder's lock: after 1 s a process runs without a claim. */
class ProcessorClaim
{
public:
  /** @param session identifies the session, e.g. the URI of its ROS master
   *  @param allowed processors
   *  @param folder of the claims; created if missing */
  ProcessorClaim(const std::string& session, const std::vector<int>& allowed, const std::string& folder = kClaimFolder);
  ~ProcessorClaim();
  ProcessorClaim(const ProcessorClaim&) = delete;
  ProcessorClaim& operator=(const ProcessorClaim&) = delete;

  const ProcessorChoice& choice() const { return choice_; }

  /** True if other sessions can see the claim. */
  bool isVisible() const { return file_ >= 0; }

  /** Number of other sessions that use the processor at present. */
  std::size_t otherSessions() const;

private:
  std::string folder_;
  std::string session_;  ///< identifier in a file name
  ProcessorChoice choice_;
  int file_ = -1;
};

}  // namespace endovascular_sim::nodes
