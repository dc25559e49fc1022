#include "segmentation/mesh/segmented_vessel.h"

#include <algorithm>
#include <utility>

#include "segmentation/branch_verdict.h"
#include "segmentation/join_branches.h"
#include "segmentation/lumen_centreline.h"
#include "segmentation/metal_check.h"
#include "segmentation/surface/lumen_surface.h"
#include "segmentation/tree_of_ends.h"
#include "vessel/prepare/open_ends.h"
#include "vessel/prepare/prepare.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kDeepestCut = 2e-3;  // m: the surface ends in flat lids, so a shallow cut suffices

void begin(const VesselObserver& observer, const std::string& stage)
{
  if (observer.stage)
    observer.stage(stage);
}

/** Spacing of the lattice of the surface: a third of the narrowest lumen, within limits [m]. */
double latticeSpacing(const std::vector<LumenBranch>& branches)
{
  double least = 1e30;
  for (const LumenBranch& branch : branches)
    for (const Section& section : branch.sections)
      least = std::min(least, 0.5 * section.diameter());
  return std::clamp(least / 3.0, 3e-4, 5e-4);
}

/** Closed surface of genus 0; the blending range grows until the surface has no handle. */
geometry::TriangleMesh closedSurface(const std::vector<LumenBranch>& branches, int threads,
                                     std::vector<std::string>& warnings)
{
  SurfaceSettings settings;
  settings.spacing = latticeSpacing(branches);
  settings.threads = threads;
  geometry::TriangleMesh mesh;
  for (const double blend : {1.0, 1.6, 2.5})
  {
    settings.blend = blend;
    mesh = lumenSurface(branches, settings);
    if (genusOf(mesh) == 0)
      return mesh;
  }
  warnings.push_back("the surface has a handle (genus " + std::to_string(genusOf(mesh)) +
                     "): two branches touch twice; check their straightened views");
  return mesh;
}

/** Ends of the tree that become open. */
std::vector<vessel::CentrelineEnd> wantedEnds(const VesselSettings& settings, const Scan& scan,
                                              const vessel::CentrelineTree& tree, const std::string& source)
{
  const std::vector<vessel::CentrelineEnd> ends = openEnds(tree);
  std::vector<vessel::CentrelineEnd> in_patient = ends;  // in the frame of the selectors
  for (vessel::CentrelineEnd& end : in_patient)
    end.position = scan.toPatient(end.position);
  std::vector<std::size_t> open = vessel::matchingEnds(tree, in_patient, settings.open, "--open", source);
  for (const std::size_t closed : vessel::matchingEnds(tree, in_patient, settings.closed, "--closed", source))
    open.erase(std::remove(open.begin(), open.end(), closed), open.end());
  std::vector<vessel::CentrelineEnd> wanted;
  wanted.reserve(open.size());
  for (const std::size_t k : open)
    wanted.push_back(ends[k]);
  return wanted;
}

/** Mesh of a closed surface, by the stages of vessel::prepareVessel(). */
vessel::PreparedVessel prepared(const geometry::TriangleMesh& surface, const VesselSettings& settings,
                                const std::string& source, const VesselObserver& observer)
{
  vessel::PrepareOptions options;
  options.max_distance = settings.max_distance;
  options.voxel = settings.max_distance;  // the surface has no features below its lattice
  options.smooth = true;
  options.centreline = false;  // that of the sections is known
  options.full_report = false;
  try
  {
    return vessel::prepareVessel(surface, source, options, observer.stage);
  }
  catch (const InputError& error)
  {
    throw UnusableSurface(error);
  }
}

/** Opens ends of the vessel. An end that cannot be cut stays closed, with a warning. */
void open(const std::vector<vessel::CentrelineEnd>& ends, const Scan& scan, double cut_back, const std::string& source,
          SegmentedVessel& vessel)
{
  for (const vessel::CentrelineEnd& end : ends)
  {
    try
    {
      vessel::openEnd(vessel.mesh, vessel.centreline, end, std::min(cut_back, kDeepestCut / end.radius), source);
      ++vessel.open_ends;
    }
    catch (const InputError&)
    {
      vessel.warnings.push_back("an end of " + vessel.centreline.branches[static_cast<std::size_t>(end.branch)].name +
                                " near " + vessel::formatLocation(scan.toPatient(end.position)) +
                                " stays closed: a plane across it would cut other vessels; move the click away from "
                                "them");
    }
  }
}

}  // namespace

SegmentedVessel segmentVessel(const Scan& scan, const ClickSet& given, const VesselSettings& settings,
                              const std::string& source, const VesselObserver& observer)
{
  begin(observer, "segmenting the branches");
  std::vector<std::string> warnings;
  const ClickSet clicks = withBranchPerEnd(scan, given, settings.edge, warnings);
  Segmentation result = segmentBranches(scan, clicks, settings.edge, settings.threads);
  result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
  joinBranches(scan, clicks, settings.edge, settings.threads, result);
  SegmentedVessel vessel;
  vessel.branches = std::move(result.branches);
  vessel.warnings = std::move(result.warnings);
  for (const std::string& warning : metalWarnings(scan, vessel.branches))
    vessel.warnings.push_back(warning);
  for (const std::string& warning : throatWarnings(scan, vessel.branches))
    vessel.warnings.push_back(warning);
  vessel.centreline = lumenCentreline(vessel.branches);
  const std::vector<vessel::CentrelineEnd> ends = wantedEnds(settings, scan, vessel.centreline, source);
  if (observer.segmented)
    observer.segmented(vessel.branches);
  begin(observer, "uniting the branches");
  // All stages take place in the frame of the grid, so that they do not depend on the pose of the patient.
  const geometry::TriangleMesh surface = closedSurface(vessel.branches, settings.threads, vessel.warnings);
  vessel::PreparedVessel mesh = prepared(surface, settings, source, observer);
  vessel.mesh = std::move(mesh.mesh);
  vessel.report = std::move(mesh.report);
  begin(observer, "opening the ends");
  open(ends, scan, settings.cut_back, source, vessel);
  return vessel;
}

}  // namespace endovascular_sim::segmentation
