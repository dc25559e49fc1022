#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::drive
{

/** Command of a file: a row of `time,instrument,command,values`. */
struct TimedCommand
{
  double time = 0.0;           ///< simulated time from which it acts [s]
  std::string instrument;      ///< name of the instrument
  std::string word;            ///< servo_jp, servo_jr, servo_jv, servo_jf, move_jp, move_jr, or a state command
  std::vector<double> values;  ///< insertion, rotation and pressure in this order; the last ones may be missing
  int line = 0;                ///< line of the file, from 1
};

/** Reads a file of commands. Empty rows and lines that begin with # are ignored, as is a row before the first command
 *  that begins with "time". Quotation marks around a field and a byte order mark are allowed.
 *  @throws InputError for a missing file, and for a row with its line: a time that is no number or less than the one
 *          before, an unknown command, a wrong number of values, or a value that is no number */
std::vector<TimedCommand> readCommandFile(const std::string& path);

}  // namespace endovascular_sim::drive
