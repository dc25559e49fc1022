#include "vessel/lesion/add_lesions.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "geometry/mesh_distance.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/centreline/lumen_section.h"
#include "vessel/lesion/lesion_mesh.h"
#include "vessel/lesion/lesion_shape.h"
#include "vessel/model/vessel.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kHighestGrade = 0.99;
constexpr double kGradeTolerance = 0.05;  // largest deviation of the measured grade in a separate lumen
constexpr int kCentrelinePoints = 24;     // minimum number of centreline segments over a lesion

std::string branchNames(const CentrelineTree& tree)
{
  std::string names;
  for (const CentrelineBranch& branch : tree.branches)
    names += (names.empty() ? "" : ", ") + branch.name;
  return names;
}

/** Replaces a point in the lumen by its branch and arc length. */
Lesion resolvePoint(Lesion lesion, const CentrelineTree& tree, const std::string& origin, const std::string& key)
{
  if (!lesion.at)
    return lesion;
  const int nearest = BranchFinder(tree).nearest(*lesion.at);
  if (nearest < 0)
    throw InputError(origin, key + ".at", "the vessel has no centreline");
  const CentrelineBranch& branch = tree.branches[static_cast<std::size_t>(nearest)];
  const geometry::Polyline line(branch.points);
  const geometry::Polyline::Foot foot = line.nearest(*lesion.at);
  const double radius = line.interpolate(branch.radii, foot.arc);
  if (foot.distance > radius)
    throw InputError(origin, key + ".at",
                     "lies " + inMillimetres(foot.distance - radius) + " outside of the nearest lumen, \"" +
                         branch.name + "\"; specify a point in the vessel in the patient frame [m]");
  lesion.branch = branch.name;
  lesion.from_start = foot.arc;
  return lesion;
}

/** Validates a lesion and locates it on its branch. */
PlacedLesion locate(const Lesion& specified, const CentrelineTree& tree, const std::string& source,
                    const std::string& origin, const std::string& key)
{
  const Lesion lesion = resolvePoint(specified, tree, origin, key);
  PlacedLesion placed;
  placed.lesion = lesion;
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
    if (tree.branches[b].name == lesion.branch)
      placed.branch = static_cast<int>(b);
  if (placed.branch < 0)
    throw InputError(origin, key + ".branch",
                     "no branch \"" + lesion.branch + "\" in " + source + "; it has " + branchNames(tree));
  if (!(lesion.grade >= 0.0 && lesion.grade <= kHighestGrade))
    throw InputError(origin, key + ".grade", "must be a diameter stenosis between 0 and 0.99");
  if (!(lesion.eccentricity >= 0.0 && lesion.eccentricity <= 1.0))
    throw InputError(origin, key + ".eccentricity", "must be between 0 (concentric) and 1 (plaque on one side)");
  if (!(lesion.length > 0.0))
    throw InputError(origin, key + ".length", "must be positive [m]");
  const double length = geometry::Polyline(tree.branches[static_cast<std::size_t>(placed.branch)].points).length();
  placed.middle = std::isnan(lesion.from_start) ? lesion.fraction * length : lesion.from_start;
  placed.begin = placed.middle - 0.5 * lesion.length;
  placed.end = placed.middle + 0.5 * lesion.length;
  if (lesion.length > length)
    throw InputError(origin, key + ".length",
                     "is longer than the branch \"" + lesion.branch + "\", " + inMillimetres(length));
  if (!(placed.begin >= 0.0 && placed.end <= length))
    throw InputError(origin,
                     key + (lesion.at                       ? ".at"
                            : std::isnan(lesion.from_start) ? ".fraction"
                                                            : ".from_start"),
                     "the lesion extends beyond its branch: its centre must be between " +
                         inMillimetres(0.5 * lesion.length) + " and " + inMillimetres(length - 0.5 * lesion.length) +
                         " from the start of \"" + lesion.branch + "\"");
  return placed;
}

/** Rejects a lesion at a location where its branch still runs inside a wider branch. */
void requireSeparateLumen(const PlacedLesion& placed, const CentrelineTree& tree, const std::string& origin,
                          const std::string& key)
{
  const CentrelineBranch& branch = tree.branches[static_cast<std::size_t>(placed.branch)];
  const geometry::Polyline own(branch.points);
  const Eigen::Vector3d middle = own.at(placed.middle);
  for (const CentrelineBranch& other : tree.branches)
  {
    if (&other == &branch)
      continue;
    const geometry::Polyline axis(other.points);
    const geometry::Polyline::Foot foot = axis.nearest(middle);
    const double radius = axis.interpolate(other.radii, foot.arc);
    const bool beside = foot.arc > 0.0 && foot.arc < axis.length();
    if (beside && foot.distance < radius && radius > own.interpolate(branch.radii, placed.middle))
      throw InputError(origin, key,
                       "\"" + branch.name + "\" still runs inside of \"" + other.name +
                           "\" there; move the lesion along the branch");
  }
}

/** Removes consecutive duplicate points. */
CentrelineTree dropDuplicatePoints(CentrelineTree tree)
{
  for (CentrelineBranch& branch : tree.branches)
    for (std::size_t k = branch.points.size(); k-- > 1;)
      if (branch.points[k] == branch.points[k - 1])
      {
        branch.points.erase(branch.points.begin() + static_cast<std::ptrdiff_t>(k));
        branch.radii.erase(branch.radii.begin() + static_cast<std::ptrdiff_t>(k));
      }
  return tree;
}

/** Inserts centreline points within the lesion to resolve its shape. */
void refineCentreline(CentrelineBranch& branch, const PlacedLesion& placed)
{
  const double longest = placed.lesion.length / kCentrelinePoints;
  CentrelineBranch fine = branch;
  fine.points.assign(1, branch.points.front());
  fine.radii.assign(1, branch.radii.front());
  double arc = 0.0;
  for (std::size_t k = 1; k < branch.points.size(); ++k)
  {
    const Eigen::Vector3d chord = branch.points[k] - branch.points[k - 1];
    const bool within = arc + chord.norm() > placed.begin && arc < placed.end;
    const int pieces = within ? std::max(1, static_cast<int>(std::ceil(chord.norm() / longest))) : 1;
    for (int i = 1; i < pieces; ++i)
    {
      const double t = static_cast<double>(i) / pieces;
      fine.points.emplace_back(branch.points[k - 1] + t * chord);
      fine.radii.push_back((1.0 - t) * branch.radii[k - 1] + t * branch.radii[k]);
    }
    fine.points.push_back(branch.points[k]);
    fine.radii.push_back(branch.radii[k]);
    arc += chord.norm();
  }
  branch = std::move(fine);
}

/** Maps the centreline and its radii. Ends of other branches stay attached to moved points. */
void narrowCentreline(CentrelineTree& tree, const PlacedLesion& placed, const LesionShape& shape)
{
  CentrelineBranch& branch = tree.branches[static_cast<std::size_t>(placed.branch)];
  for (std::size_t k = 0; k < branch.points.size(); ++k)
  {
    const LesionShape::Image image = shape.map(branch.points[k]);
    if (image.narrowing <= 0.0)
      continue;
    for (CentrelineBranch& other : tree.branches)
      for (Eigen::Vector3d* end : {&other.points.front(), &other.points.back()})
        if (&other != &branch && *end == branch.points[k])
          *end = image.position;
    branch.points[k] = image.position;
    branch.radii[k] *= 1.0 - image.narrowing;
  }
}

void requireGrade(const PlacedLesion& placed, const std::string& origin, const std::string& key)
{
  const double grade = 1.0 - placed.narrowed_diameter / placed.healthy_diameter;
  if (std::abs(grade - placed.lesion.grade) <= kGradeTolerance)
    return;
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "\"" << placed.lesion.branch << "\" has no separate lumen there (grade "
       << placed.lesion.grade << " specified, " << grade
       << " measured): it runs inside of another branch or through a junction; move the lesion along the branch";
  throw InputError(origin, key, text.str());
}

std::string noteOf(const PlacedLesion& placed)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "lesion on " << placed.lesion.branch << ": "
       << 1e3 * placed.narrowed_diameter << " mm of " << 1e3 * placed.healthy_diameter << " mm remain";
  return text.str();
}

}  // namespace

void addLesions(Vessel& vessel, const std::vector<Lesion>& lesions, const std::string& origin,
                const ProgressReport& progress)
{
  if (lesions.empty())
    return;
  const CentrelineTree healthy = dropDuplicatePoints(vessel.centreline);
  vessel.centreline = healthy;
  std::vector<PlacedLesion> all;
  for (std::size_t k = 0; k < lesions.size(); ++k)
  {
    const std::string key = "vessel.lesions." + std::to_string(k);
    all.push_back(locate(lesions[k], healthy, vessel.source, origin, key));
    requireSeparateLumen(all.back(), healthy, origin, key);
  }
  for (std::size_t k = 0; k < all.size(); ++k)
  {
    const std::string key = "vessel.lesions." + std::to_string(k);
    reportProgress(progress, "lesions", static_cast<double>(k) / static_cast<double>(all.size()));
    PlacedLesion& placed = all[k];
    const CentrelineBranch& branch = healthy.branches[static_cast<std::size_t>(placed.branch)];
    const LesionShape shape(branch, placed.lesion, placed.middle);
    const geometry::MeshDistance healthy_distance(vessel.mesh);
    placed.healthy_diameter = lumenDiameter(healthy_distance, shape.middle(), shape.direction());
    geometry::TriangleMesh narrowed = narrowedMesh(vessel.mesh, branch, placed.lesion, placed.middle);
    if (hasFoldedFaces(narrowed, vessel.mesh, shape))
      throw InputError(origin, key,
                       "the wall would fold there; move the lesion away from the junction, increase its length, or "
                       "reduce its grade");
    const geometry::MeshDistance narrowed_distance(narrowed);
    placed.narrowed_diameter = lumenDiameter(narrowed_distance, shape.map(shape.middle()).position, shape.direction());
    requireGrade(placed, origin, key);
    vessel.mesh = std::move(narrowed);
    refineCentreline(vessel.centreline.branches[static_cast<std::size_t>(placed.branch)], placed);
    narrowCentreline(vessel.centreline, placed, shape);
    vessel.notes.push_back(noteOf(placed));
  }
  requireClean(checkMesh(vessel.mesh), origin);
  // Eccentric lesions lengthen a branch: arc lengths are converted to the narrowed centreline.
  for (PlacedLesion& placed : all)
  {
    const geometry::Polyline before(healthy.branches[static_cast<std::size_t>(placed.branch)].points);
    const LesionShape shape(healthy.branches[static_cast<std::size_t>(placed.branch)], placed.lesion, placed.middle);
    const geometry::Polyline now(vessel.centreline.branches[static_cast<std::size_t>(placed.branch)].points);
    const Eigen::Vector3d middle = shape.map(shape.middle()).position;
    const Eigen::Vector3d ends[2] = {before.at(placed.begin), before.at(placed.end)};
    placed.begin = now.nearest(ends[0]).arc;
    placed.middle = now.nearest(middle).arc;
    placed.end = now.nearest(ends[1]).arc;
    vessel.lesions.push_back(placed);
  }
}

}  // namespace endovascular_sim::vessel
