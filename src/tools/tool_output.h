#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "common/output_file.h"
#include "common/process/child_process.h"

namespace endovascular_sim::tools
{

/** Prints warnings on the error stream, one per line. */
inline void printWarnings(const std::string& program, const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
    std::cerr << program << ": warning: " << warning << "\n";
}

/** Prints notes on an input on the error stream, one per line. */
inline void printNotes(const std::string& source, const std::vector<std::string>& notes)
{
  for (const std::string& note : notes)
    std::cerr << source << ": " << note << "\n";
}

/** @throws InputError when the file cannot be opened */
inline std::ofstream openFile(const std::filesystem::path& path)
{
  std::ofstream stream(path);
  if (!stream)
    throw writeError(path.string());
  return stream;
}

/** Throws when a stream could not write everything; to be called directly after its last operation.
 *  @throws InputError with the reason of the operating system */
inline void requireWritten(bool written, const std::filesystem::path& path)
{
  if (!written)
    throw writeError(path.string());
}

/** @throws InputError when the file cannot be written */
inline void writeFile(const std::filesystem::path& path, const std::string& text)
{
  writeTextFile(path.string(), text);
}

/** Throws before a long computation, rather than after it, if its result cannot be written. Changes no existing file
 * and leaves no new one.
 *  @throws InputError with the reason of the operating system */
inline void requireWritable(const std::filesystem::path& path)
{
  const bool existed = std::filesystem::exists(path);
  if (!std::ofstream(path, std::ios::app))
    throw writeError(path.string());
  if (!existed)
    std::filesystem::remove(path);
}

/** Draws a progress bar on the error stream, over the one drawn before.
 *  @param share completed share, 0 to 1 */
inline void drawProgress(double share, const std::string& text)
{
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(share * kWidth);
  std::fprintf(stderr, "\r\033[K[%s%s] %3.0f %%  %.90s", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), 100.0 * share, text.c_str());
}

/** Runs a command of the program `plots` (python/endovascular_sim/plots), which lies beside the running program.
 *  @param command its name and arguments
 *  @return false after a failure, which is reported on the error stream */
inline bool runPlots(std::vector<std::string> command)
{
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string plots = (program.parent_path() / "plots").string();
  command.insert(command.begin(), {"/usr/bin/python3", plots});
  const int code = runProgram(command);
  if (code == 0)
    return true;
  std::cerr << program.filename().string() << ": the plots could not be drawn: " << plots << " ended with exit code "
            << code << "\n";
  return false;
}

}  // namespace endovascular_sim::tools
