#include "nodes/runtime/processor/processor_claim.h"

#include <dirent.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <thread>

namespace endovascular_sim::nodes
{
namespace
{

constexpr mode_t kFolderMode = 01777;  // every account of the machine may add a claim, none may remove another's
constexpr mode_t kFileMode = 0644;
constexpr std::chrono::milliseconds kPatience{1000};  ///< longest wait for a lock
constexpr std::chrono::milliseconds kPoll{5};
constexpr char kGuard[] = "/guard";

/** Opens a file of the folder, or creates it. Any account may have put something else there, e.g. a pipe without a
 *  writer: nothing is followed or waited for. @return −1 on failure */
int openClaim(const std::string& path)
{
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  const int file = open(path.c_str(), kFlags);
  return file >= 0 ? file : open(path.c_str(), kFlags | O_CREAT, kFileMode);
}

/** Locks a file, which any account of the machine may hold, within kPatience. @return false without the lock */
bool lockSoon(int file, int operation)
{
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (flock(file, operation | LOCK_NB) != 0)
  {
    if (errno != EWOULDBLOCK || std::chrono::steady_clock::now() > end)
      return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

/** Exclusive lock on the folder of claims, for the duration of a choice. */
class FolderLock
{
public:
  explicit FolderLock(const std::string& folder)
  {
    if (mkdir(folder.c_str(), kFolderMode) == 0)
      chmod(folder.c_str(), kFolderMode);  // not reduced by the umask
    file_ = openClaim(folder + kGuard);
    is_held_ = file_ >= 0 && lockSoon(file_, LOCK_EX);
  }
  ~FolderLock()
  {
    if (file_ >= 0)
      close(file_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool isHeld() const { return is_held_; }

private:
  int file_ = -1;
  bool is_held_ = false;
};

/** Claim read from a file name `PROCESSOR-SESSION`. */
struct NamedClaim
{
  int processor = -1;
  std::string session;
};

std::optional<NamedClaim> parse(const std::string& name)
{
  const std::size_t dash = name.find('-');
  if (dash == std::string::npos || dash == 0 || dash > 4 ||
      !std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(dash),
                   [](unsigned char c) { return std::isdigit(c) != 0; }))
    return std::nullopt;
  return NamedClaim{std::atoi(name.substr(0, dash).c_str()), name.substr(dash + 1)};
}

/** True if a living process holds the claim.
 *  @param removes_dead true: removes a file that none holds */
bool isAlive(const std::string& path, bool removes_dead)
{
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0)
    return false;
  const bool dead = flock(file, LOCK_EX | LOCK_NB) == 0;
  if (dead && removes_dead)
    unlink(path.c_str());
  close(file);
  return !dead;
}

/** Claims of living processes.
 *  @param is_locked true: the folder is locked, so that files which no process holds are removed */
std::vector<NamedClaim> livingClaims(const std::string& folder, bool is_locked)
{
  std::vector<NamedClaim> claims;
  DIR* const directory = opendir(folder.c_str());
  if (directory == nullptr)
    return claims;
  while (const dirent* const entry = readdir(directory))
    if (const std::optional<NamedClaim> claim = parse(entry->d_name))
      if (isAlive(folder + "/" + entry->d_name, is_locked))
        claims.push_back(*claim);
  closedir(directory);
  return claims;
}

}  // namespace

std::vector<int> allowedProcessors()
{
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  std::vector<int> processors;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
    return processors;
  for (int processor = 0; processor < CPU_SETSIZE; ++processor)
    if (CPU_ISSET(processor, &allowed))
      processors.push_back(processor);
  return processors;
}

ProcessorClaim::ProcessorClaim(const std::string& session, const std::vector<int>& allowed, const std::string& folder)
  : folder_(folder), session_(session)
{
  for (char& c : session_)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0)
      c = '_';
  const FolderLock lock(folder_);
  std::vector<int> held;
  bool joined = false;
  for (const NamedClaim& claim : livingClaims(folder_, lock.isHeld()))
  {
    if (claim.session != session_)
      held.push_back(claim.processor);
    else if (std::find(allowed.begin(), allowed.end(), claim.processor) != allowed.end())
    {
      choice_.processor = claim.processor;
      joined = true;
    }
  }
  if (joined)
    choice_.other_sessions = static_cast<std::size_t>(std::count(held.begin(), held.end(), choice_.processor));
  else
    choice_ = chooseProcessor(allowed, held);
  if (!lock.isHeld() || choice_.processor < 0)
    return;
  const std::string path = folder_ + "/" + std::to_string(choice_.processor) + "-" + session_;
  file_ = openClaim(path);
  if (file_ >= 0 && !lockSoon(file_, LOCK_SH))
  {
    close(file_);
    file_ = -1;
  }
}

ProcessorClaim::~ProcessorClaim()
{
  if (file_ >= 0)
    close(file_);
}

std::size_t ProcessorClaim::otherSessions() const
{
  std::size_t others = 0;
  for (const NamedClaim& claim : livingClaims(folder_, false))
    others += claim.processor == choice_.processor && claim.session != session_ ? 1 : 0;
  return others;
}

}  // namespace endovascular_sim::nodes
