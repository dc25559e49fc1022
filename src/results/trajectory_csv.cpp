#include "results/trajectory_csv.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "common/output_file.h"

namespace endovascular_sim::results
{

std::string toCsv(const TrajectoryRow& row)
{
  std::array<char, 400> text{};
  const int length =
      std::snprintf(text.data(), text.size(), "%.9g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%zu,%.17g,%.17g",
                    row.time, row.insertion, row.rotation, row.hand_force, row.hand_torque, row.tip.x(), row.tip.y(),
                    row.tip.z(), row.nodes, row.pressure, row.tip_rotation);
  return {text.data(), static_cast<std::size_t>(length)};
}

TrajectoryFile::TrajectoryFile(const std::string& file, double rate) : file_(file), stream_(file), rate_(rate)
{
  if (!(stream_ << kTrajectoryColumns << '\n'))
    throw writeError(file);
}

bool TrajectoryFile::add(const TrajectoryRow& row)
{
  // Slots of simulated time make the rows independent of the arrival of messages. The small term assigns a time at a
  // boundary to the slot that begins there, despite rounding.
  const double slot = std::floor(row.time * rate_ + 1e-6);
  if (slot <= last_slot_)
    return true;
  last_slot_ = slot;
  stream_ << toCsv(row) << '\n';
  return isGood();
}

bool TrajectoryFile::flush()
{
  stream_.flush();
  return isGood();
}

/** Saves the reason of the first failure. An open file can be written after its removal too, but is lost. */
bool TrajectoryFile::isGood()
{
  if (!stream_ && error_.empty())
    error_ = writeError(file_).what();
  if (error_.empty() && access(file_.c_str(), F_OK) != 0)
    error_ = InputError(file_, "",
                        "was removed or moved during the run, perhaps with its folder: the results are lost; begin "
                        "again, and leave the folder until the end")
                 .what();
  return error_.empty();
}

}  // namespace endovascular_sim::results
