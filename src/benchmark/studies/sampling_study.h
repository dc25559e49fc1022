#pragma once

#include <string>
#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** A driven wire whose sampling is varied. */
struct SamplingCase
{
  std::string name;
  std::string scene_yaml;  ///< the scene without `sampling`
  double duration = 0.0;   ///< [s]
  double min_edge = 0.5e-3;
  double max_edge = 2.0e-3;
  double turn_per_edge = 0.05;
};

/** How a run compares with the reference of its case. */
struct SamplingResult
{
  std::string case_name;
  std::string sampling;  ///< "uniform 0.5 mm", "adaptive", …
  double mean_inserted_nodes = 0.0;
  double mean_simulated_nodes = 0.0;  ///< with those in the introducer's guide
  double largest_inserted_nodes = 0.0;
  double step_time = 0.0;      ///< processor time of a step [s]
  double sampling_time = 0.0;  ///< of it for sampling [s]
  double rms_distance = 0.0;   ///< of the centreline to the reference's, over wire and time [m]
  double max_distance = 0.0;   ///< [m]
  double rms_tip_error = 0.0;  ///< [m]
  double max_tip_error = 0.0;  ///< [m]
  double energy_error = 0.0;   ///< largest, of the reference's largest bending energy
  /** RMS difference of the hand's force over the reference's peak; both as means over kForceWindow. */
  double force_error = 0.0;
  double raw_force_error = 0.0;  ///< the same of the force of every single step
  double force_peak = 0.0;       ///< of the reference's mean force [N]
  double largest_jump = 0.0;     ///< of the force from step to step, of the peak; with the facets' and the snaps'
  double resampling_jump =
      -1.0;                  ///< largest change of a step's force by resampling before it, of the peak; −1: unknown
  double penetration = 0.0;  ///< deepest [m]
  int resamplings = 0;
  int unsolved = 0;

  bool isAdaptive() const { return resamplings > 0; }
};

/** A measure of an adaptive run with its limit, and the same measure of uniform 0.5 mm. */
struct SamplingVerdict
{
  std::string measure;
  double value = 0.0;
  double limit = 0.0;
  double uniform = 0.0;  ///< what uniform 0.5 mm reaches itself
  bool holds() const { return value <= limit; }
};

/** Mean over which the hand feels force [s]: 20 ms. */
constexpr double kForceWindow = 20e-3;

/** The three anatomies, each pushed, drawn back and turned.
 *  @param mesh path of aortic_arch_tree.obj; empty leaves that case out
 *  @param quick shorter motions */
std::vector<SamplingCase> samplingCases(const std::string& mesh, bool quick);

/** Runs one case: the reference (uniform 0.125 mm), uniform 0.5, 0.8 mm, adaptive, and uniform with as many nodes as
 *  adaptive. The reference comes first.
 *  @param jump_samples resamplings whose effect on the force is measured, each by a run of its own: those at
 *    which the force changes most
 *  @throws InputError when the scene is refused */
std::vector<SamplingResult> studySampling(const SamplingCase& study, int jump_samples, const Progress& progress);

/** The acceptance measures, from the results of one case. */
std::vector<SamplingVerdict> judgeSampling(const std::vector<SamplingResult>& results);

}  // namespace endovascular_sim::benchmark
