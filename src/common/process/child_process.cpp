#include "common/process/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>

namespace endovascular_sim
{
namespace
{

/** Replaces the process by a program, or writes to @p failure and ends. Only calls that are safe after fork(). */
[[noreturn]] void become(char* const* arguments, pid_t parent, int failure)
{
  endWithParent(parent);
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (null >= 0 && dup2(null, STDOUT_FILENO) >= 0)
    execv(arguments[0], arguments);
  const char mark = 0;
  [[maybe_unused]] const ssize_t written = write(failure, &mark, 1);
  _exit(127);
}

/** Waits for a child. @return its status, −1 where it cannot be waited for */
int statusOf(pid_t child)
{
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      return -1;
  return status;
}

}  // namespace

void endWithParent(pid_t parent)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent)  // it has ended before
    _exit(127);
}

int runProgram(const std::vector<std::string>& command)
{
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  std::array<int, 2> failure{};  // a started program closes it without a byte
  if (command.empty() || pipe2(failure.data(), O_CLOEXEC) != 0)
    return -1;
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0)
    become(arguments.data(), parent, failure[1]);
  close(failure[1]);
  char mark = 0;
  ssize_t count = 0;
  do
    count = read(failure[0], &mark, 1);
  while (count < 0 && errno == EINTR);
  const bool has_started = child > 0 && count == 0;
  close(failure[0]);
  const int status = child > 0 ? statusOf(child) : -1;
  if (!has_started || status == -1)
    return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace endovascular_sim
