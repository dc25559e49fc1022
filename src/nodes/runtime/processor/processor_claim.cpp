#include "nodes/runtime/processor_claim.h"

#include <dirent.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>

namespace endovascular_sim::nodes
{
namespace
{

constexpr mode_t kFolderMode = 01777;  // every account of the machine may add a claim, none may remove another's
constexpr mode_t kFileMode = 0644;
constexpr char kGuard[] = "/guard";

/** Exclusive lock on the folder of claims, for the duration of a choice. */
class FolderLock
{
public:
  explicit FolderLock(const std::string& folder)
  {
    if (mkdir(folder.c_str(), kFolderMode) == 0)
      chmod(folder.c_str(), kFolderMode);  // not reduced by the umask
    const std::string path = folder + kGuard;
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0)
      file_ = open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, kFileMode);
    if (file_ >= 0)
      flock(file_, LOCK_EX);
  }
  ~FolderLock()
  {
    if (file_ >= 0)
      close(file_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool isHeld() const { return file_ >= 0; }

private:
  int file_ = -1;
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

/** True if a living process holds the claim. Removes a file that none holds. */
bool isAlive(const std::string& path)
{
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return false;
  const bool dead = flock(file, LOCK_EX | LOCK_NB) == 0;
  if (dead)
    unlink(path.c_str());
  close(file);
  return !dead;
}

/** Claims of living processes. The folder must be locked. */
std::vector<NamedClaim> livingClaims(const std::string& folder)
{
  std::vector<NamedClaim> claims;
  DIR* const directory = opendir(folder.c_str());
  if (directory == nullptr)
    return claims;
  while (const dirent* const entry = readdir(directory))
    if (const std::optional<NamedClaim> claim = parse(entry->d_name))
      if (isAlive(folder + "/" + entry->d_name))
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
  for (const NamedClaim& claim : livingClaims(folder_))
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
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0)
    file_ = open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, kFileMode);
  if (file_ >= 0)
    flock(file_, LOCK_SH);
}

ProcessorClaim::~ProcessorClaim()
{
  if (file_ >= 0)
    close(file_);
}

std::size_t ProcessorClaim::otherSessions() const
{
  const FolderLock lock(folder_);
  std::size_t others = 0;
  for (const NamedClaim& claim : livingClaims(folder_))
    others += claim.processor == choice_.processor && claim.session != session_ ? 1 : 0;
  return others;
}

}  // namespace endovascular_sim::nodes
