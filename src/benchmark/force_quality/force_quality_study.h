#pragma once

#include <string>
#include <vector>

#include "benchmark/force_quality/force_quality.h"
#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Reactions at the hands of a scene after every step, by instrument. Instruments that clients drive are moved in turn,
 * from the outermost one: pushed at 20 mm/s and turned to and fro at 1 rad/s.
 *  @param scene path, or name of a shipped scene
 *  @param seconds simulated time, at most the scene's duration [s] */
std::vector<std::vector<HandReaction>> reactionsIn(const std::string& scene, const std::vector<std::string>& overrides,
                                                   double seconds);

/** Tables of forceQualityStudy(). */
std::vector<TableSpec> forceQualityTables();

/** Largest change per millisecond and noise of force and torque at the hands, in every shipped scene. */
std::vector<Section> forceQualityStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
