#pragma once

#include <string>
#include <vector>

namespace endovascular_sim
{

/** Runs a program to its end, without a shell: every argument is passed literally.
 *  @param command path of the program, then its arguments
 *  @return exit code; 128 + signal when a signal ended it, −1 when it could not be started. Its standard output is
 *          discarded, its standard error is that of this process */
int runProgram(const std::vector<std::string>& command);

}  // namespace endovascular_sim
