#pragma once

#include <unistd.h>

#include <string>
#include <vector>

namespace endovascular_sim
{

/** Lets this process end as soon as its parent ends, in whatever way. To be called in a child process.
 *  @param parent process that started this one; if it has ended already, this process ends at once */
void endWithParent(pid_t parent);

/** Runs a program to its end, without a shell: every argument is passed literally. The program ends with this process.
 *  @param command path of the program, then its arguments
 *  @return exit code; 128 + signal when a signal ended it, −1 when it could not be started. Its standard output is
 *          discarded, its standard error is that of this process */
int runProgram(const std::vector<std::string>& command);

}  // namespace endovascular_sim
