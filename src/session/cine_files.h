#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "session/x_ray_run.h"

namespace endovascular_sim::session
{

/** Interval of simulated time of a run of X-ray frames: all pulses from begin to end, both included [s]. */
struct CineTime
{
  double begin = 0.0, end = 0.0;
};

/** Interval of a text FROM:TO.
 *  @throws InputError unless 0 ≤ FROM ≤ TO are finite */
CineTime cineTimeOf(const std::string& text);

/** Files of a run of X-ray frames: frames as PNG, in the folder `cine`, and those of DSA in `dsa`; of the second
 * detector of a biplane system in `cine_2` and `dsa_2`. The name of a frame is the number of its pulse.
 * `cine/frames.csv` has a row for each: pulse, time [s], number of steps, tube charge [mAs], air kerma at the reference
 * point [Gy], and 1 where there is a frame of DSA; each of the first detector. */
class CineFiles
{
public:
  /** @param world must outlive this
   *  @param folder in which the folders are created
   *  @throws InputError as XRayRun, for an interval without a pulse, a run that ends before a frame of DSA, and if a
   *          file cannot be written */
  CineFiles(const World& world, const XRayRunSettings& settings, const CineTime& time, const std::string& folder);

  /** Draws the frame of the present step if one is due. To be called at the beginning and after every step.
   *  @throws InputError if a file cannot be written */
  void update(const Session& session);

  /** Ends the run.
   *  @return which frames are missing, and a remedy; empty if none is
   *  @throws InputError if not everything could be written */
  std::string finish();

  std::uint64_t frames() const { return frames_; }  ///< drawn so far

private:
  void write(const std::string& kind, std::size_t detector, std::uint64_t pulse, int pixels,
             const std::vector<std::uint8_t>& image) const;

  XRayRun run_;
  std::uint64_t first_, last_;  ///< pulses
  std::string folder_;
  std::ofstream table_;
  std::uint64_t frames_ = 0;
};

}  // namespace endovascular_sim::session
