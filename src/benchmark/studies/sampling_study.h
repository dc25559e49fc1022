#pragma once

#include <string>
#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Driven wire simulated with several samplings. */
struct SamplingCase
{
  std::string name;
  std::string scene_yaml;  ///< scene text without `sampling`
  double duration = 0.0;   ///< simulated time [s]
  double min_edge = 0.5e-3;
  double max_edge = 2.0e-3;
  double turn_per_edge = 0.05;
};

/** Deviations of a run from the reference of its case, with its cost. */
struct SamplingResult
{
  std::string case_name;
  std::string sampling;  ///< "uniform 0.5 mm", "adaptive", …
  double mean_inserted_nodes = 0.0;
  double mean_simulated_nodes = 0.0;  ///< mean number of nodes including those in the introducer
  double largest_inserted_nodes = 0.0;
  double step_time = 0.0;      ///< processor time per step [s]
  double sampling_time = 0.0;  ///< part of step_time for sampling [s]
  double rms_distance = 0.0;   ///< RMS distance of the centrelines over wire and time [m]
  double max_distance = 0.0;   ///< largest distance of the centrelines [m]
  double rms_tip_error = 0.0;  ///< RMS distance of the tips [m]
  double max_tip_error = 0.0;  ///< largest distance of the tips [m]
  double energy_error = 0.0;   ///< largest error over the largest bending energy of the reference
  /** RMS difference of the hand force over the peak of the reference; both are means over kForceWindow. */
  double force_error = 0.0;
  double raw_force_error = 0.0;  ///< force_error with the forces of single steps
  double force_peak = 0.0;       ///< peak of the mean force of the reference [N]
  double largest_jump =
      0.0;  ///< largest change of the force between steps over the peak, including facets and snap-through
  double resampling_jump = -1.0;  ///< largest change of the force by a resampling over the peak; −1: unknown
  double penetration = 0.0;       ///< largest penetration depth [m]
  int resamplings = 0;
  int unsolved = 0;

  bool isAdaptive() const { return resamplings > 0; }
};

/** Acceptance measure of an adaptive run with its limit. */
struct SamplingVerdict
{
  std::string measure;
  double value = 0.0;
  double limit = 0.0;
  double uniform = 0.0;  ///< value of the measure for uniform 0.5 mm
  bool holds() const { return value <= limit; }
};

/** Averaging time of the hand force [s]. */
constexpr double kForceWindow = 20e-3;

/** Cases in three vessels, each with push, withdrawal and rotation.
 *  @param mesh path of aortic_arch_tree.obj; empty: without that case
 *  @param quick shorter motions */
std::vector<SamplingCase> samplingCases(const std::string& mesh, bool quick);

/** Runs one case: the reference (uniform 0.125 mm) first, then uniform 0.5 and 0.8 mm, adaptive, and uniform with as
 * many nodes as adaptive.
 *  @param jump_samples number of resamplings whose effect on the force is measured, each by a separate run: those with
 *    the largest change of the force
 *  @throws InputError for a rejected scene */
std::vector<SamplingResult> studySampling(const SamplingCase& study, int jump_samples, const Progress& progress);

/** Acceptance measures of the results of one case. */
std::vector<SamplingVerdict> judgeSampling(const std::vector<SamplingResult>& results);

}  // namespace endovascular_sim::benchmark
