#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/quantities.h"
#include "fluoroscopy/angiography/angiography.h"
#include "session/cine_files.h"
#include "tools/command_line.h"

namespace endovascular_sim::tools
{

/** Options of a run of X-ray frames: `--cine`, `--cine-view`, `--dsa`, `--roadmap`. */
class CineOptions
{
public:
  /** Adds the options to a command line. @return `--cine` */
  CLI::Option* addTo(CommandLine& line)
  {
    CLI::Option* cine = line.option(
        "--cine", interval_, "FROM:TO",
        "writes a run of X-ray frames at the pulses between two simulated times [s]: cine/frame_000030.png and so on, "
        "named by the pulse, and cine/frames.csv");
    line.repeated(
            "--cine-view", views_, "VIEW",
            "view of the run, e.g. \"LAO 40\"; a second one makes the run biplane: cine_2. Default: that of the scene")
        ->needs(cine);
    CLI::Option* dsa =
        line.option("--dsa", mask_frames_, "N",
                    "also writes dsa/frame_000034.png and so on: the frames minus the mean of the first N of the run")
            ->check(CLI::Range(1, fluoroscopy::Angiography::kMostMaskFrames))
            ->needs(cine);
    roadmap_ = line.quantity("--roadmap", roadmap_at_, "T", quantities::kDuration,
                             "simulated time at which the run of DSA ends [s]: later frames show its roadmap")
                   ->needs(dsa);
    return cine;
  }

  /** True with `--cine`. */
  bool isGiven() const { return !interval_.empty(); }

  const std::string& interval() const { return interval_; }

  session::XRayRunSettings settings() const
  {
    session::XRayRunSettings settings;
    if (!views_.empty())
      settings.views = views_;
    settings.mask_frames = mask_frames_;
    if (roadmap_->count() > 0)
      settings.roadmap_at = roadmap_at_;
    return settings;
  }

private:
  std::string interval_;
  std::vector<std::string> views_;  ///< empty: that of the scene
  int mask_frames_ = 0;
  double roadmap_at_ = 0.0;
  CLI::Option* roadmap_ = nullptr;
};

}  // namespace endovascular_sim::tools
