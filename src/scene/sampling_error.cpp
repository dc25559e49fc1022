#include "scene/sampling_error.h"

#include <algorithm>

#include "common/text/format.h"
#include "vessel/centreline/centreline_curvature.h"

namespace endovascular_sim::scene
{
namespace
{

constexpr double kBendShare = 0.05;   // measured in tubes: docs/validation/sampling_error.csv
constexpr double kMouthShare = 1.5;   // a cantilever, force ∝ 1/ℓ³, whose clamp is known to within half an edge
constexpr double kSearchStep = 1e-3;  // m
constexpr double kLongestFree = 0.1;  // m: a wire that is free for longer exerts little force

/** Length over which a straight wire enters the vessel without contact [m]. */
double straightLength(const vessel::Vessel& vessel, const EntryPose& entry, double radius)
{
  double length = 0.0;
  while (length < kLongestFree && distanceToWall(entry.position + length * entry.direction, vessel.mesh) > radius)
    length += kSearchStep;
  return length;
}

/** Length of the pre-curved end of a wire [m]; 0 for a straight one. */
double curvedLength(const rod::Wire& wire)
{
  double length = 0.0;
  for (auto section = wire.sections.rbegin(); section != wire.sections.rend(); ++section)
    if (!section->rest_curvature.isZero(0.0))
      length += section->length;
  return length;
}

/** Length of the edges where the wire has a curvature [m]. */
double edgeAt(const SamplingScene& sampling, double length, double curvature)
{
  if (sampling.kind == SamplingKind::kUniform)
    return length / (sampling.nodes - 1);
  const double wanted = curvature > 0.0 ? sampling.turn_per_edge / curvature : sampling.max_edge;
  return std::clamp(wanted, sampling.min_edge, sampling.max_edge);
}

/** Finds the bend with the largest error. A point closer to an end of its branch than the lumen's radius does not
 * count: its curvature is that of the junction. */
void findBend(const Scene& scene, const vessel::CentrelineTree& tree, double length, double radius,
              SamplingError& error)
{
  const vessel::CentrelineCurvature curvatures(tree);
  double largest = 0.0;
  for (const vessel::CentrelineBranch& branch : tree.branches)
    for (std::size_t i = 0; i < branch.points.size(); ++i)
    {
      const double lumen = branch.radii[i];
      const bool junction = (branch.points[i] - branch.points.front()).norm() < lumen ||
                            (branch.points[i] - branch.points.back()).norm() < lumen;
      const double curvature = curvatures.at(branch.points[i]);
      if (junction || lumen <= radius || curvature <= 0.0)
        continue;
      const double edge = edgeAt(scene.sampling, length, curvature);
      const double strain = edge * edge * curvature / (lumen - radius);
      if (strain <= largest)
        continue;
      largest = strain;
      error.edge = edge;
      error.bend_radius = 1.0 / curvature;
      error.clearance = lumen - radius;
    }
}

}  // namespace

double SamplingError::inBend() const
{
  return bend_radius > 0.0 ? kBendShare * edge * edge / (bend_radius * clearance) : 0.0;
}

double SamplingError::atMouth() const
{
  return free_length > 0.0 ? kMouthShare * mouth_edge / free_length : 0.0;
}

std::string SamplingError::text() const
{
  std::string text = "expected error of the hand force by the sampling:";
  if (free_length <= 0.0 && bend_radius <= 0.0)
    text += " not known, because no bend is wider than the wire and the wire touches the wall where it begins";
  if (free_length > 0.0)
  {
    text += formatted(" %.1f %% at the introducer (edges of %.2f mm, free length %.0f mm)", 100.0 * atMouth(),
                      1e3 * mouth_edge, 1e3 * free_length);
  }
  if (bend_radius > 0.0)
  {
    text += formatted("%s %.2g %% in the narrowest bend (edges of %.2f mm, radius %.1f mm, clearance %.1f mm)",
                      free_length > 0.0 ? "," : "", 100.0 * inBend(), 1e3 * edge, 1e3 * bend_radius, 1e3 * clearance);
  }
  return text;
}

SamplingError expectedSamplingError(const Scene& scene, const vessel::Vessel& vessel, const EntryPose& entry)
{
  SamplingError error;
  const rod::Wire& wire = scene.instruments.front().instrument.wire;
  const double length = wire.length();
  const double radius = wire.sections.back().radius;
  if (scene.introducer)
  {
    const double curved = curvedLength(wire);
    error.free_length = straightLength(vessel, entry, radius);
    if (curved > 0.0)
      error.free_length = std::min(error.free_length, curved);
    error.mouth_edge = scene.sampling.kind == SamplingKind::kUniform ? edgeAt(scene.sampling, length, 0.0)
                                                                     : 0.5 * scene.sampling.min_edge;
  }
  findBend(scene, vessel.centreline, length, radius, error);
  return error;
}

}  // namespace endovascular_sim::scene
