#include "vessel/anatomy/anatomy_mesh.h"

#include <cstdlib>
#include <optional>

#include "common/error.h"
#include "common/hash.h"
#include "geometry/polyline.h"
#include "vessel/anatomy/implicit_vessel.h"
#include "vessel/anatomy/implicit_vessel_remesh.h"
#include "vessel/anatomy/iso_surface.h"
#include "vessel/io/mesh_cache.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/remesh.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Stenoses of the anatomy as lesions of the vessel. */
std::vector<PlacedLesion> lesionsOf(const Anatomy& anatomy, const CentrelineTree& centreline)
{
  std::vector<PlacedLesion> lesions;
  for (std::size_t b = 0; b < anatomy.branches.size(); ++b)
    for (const Stenosis& stenosis : anatomy.branches[b].stenoses)
    {
      const geometry::Polyline line(centreline.branches[b].points);
      PlacedLesion placed;
      placed.branch = static_cast<int>(b);
      placed.middle = stenosis.position * line.length();
      placed.begin = placed.middle - 0.5 * stenosis.length;
      placed.end = placed.middle + 0.5 * stenosis.length;
      placed.narrowed_diameter = 2.0 * line.interpolate(centreline.branches[b].radii, placed.middle);
      placed.healthy_diameter = placed.narrowed_diameter / (1.0 - stenosis.reduction);
      placed.lesion.branch = anatomy.branches[b].name;
      placed.lesion.from_start = placed.middle;
      placed.lesion.length = stenosis.length;
      placed.lesion.grade = stenosis.reduction;
      lesions.push_back(placed);
    }
  return lesions;
}

}  // namespace

geometry::TriangleMesh generateAnatomyMesh(const Anatomy& anatomy, const std::vector<AnatomyChain>& chains)
{
  const ImplicitVessel field(anatomy, chains);
  geometry::TriangleMesh mesh = remesh(isoSurface(field), field);
  const MeshReport report = checkMesh(mesh);
  requireClean(report, anatomy.file);
  if (report.genus != 0)
    throw InputError(anatomy.file, "branches",
                     "branches that are not parent and child overlap, so that the lumen has " +
                         std::to_string(report.genus) +
                         " loops; move their points apart, reduce their diameters, or reduce blend");
  return mesh;
}

std::string anatomyCacheFolder()
{
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/')
    return std::string(cache) + "/endovascular_sim";
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? std::string(home) + "/.cache/endovascular_sim" : std::string();
}

Vessel loadAnatomy(const std::string& file, const std::string& cache_folder)
{
  const Anatomy anatomy = readAnatomy(file);
  const std::vector<AnatomyChain> chains = sampleChains(anatomy);
  Vessel vessel;
  vessel.source = file;
  vessel.warnings = anatomy.warnings;
  vessel.centreline = anatomyCentreline(anatomy, chains);
  vessel.lesions = lesionsOf(anatomy, vessel.centreline);

  Hash64 key;
  key.add(anatomy.content_hash);
  key.add(static_cast<std::uint64_t>(kAnatomyGeneratorVersion));
  const std::string entry = cache_folder.empty() ? std::string() : cache_folder + "/anatomy_" + key.hex() + ".mesh";
  std::optional<geometry::TriangleMesh> cached;
  if (!entry.empty())
    cached = readCachedMesh(entry, key.value());
  if (cached)
  {
    vessel.mesh = std::move(*cached);
    vessel.notes.push_back("mesh of \"" + anatomy.name + "\" loaded from " + entry);
    return vessel;
  }
  vessel.mesh = generateAnatomyMesh(anatomy, chains);
  vessel.notes.push_back("mesh of \"" + anatomy.name + "\" generated: " + std::to_string(vessel.mesh.triangles.size()) +
                         " triangles");
  if (!entry.empty() && !writeCachedMesh(entry, key.value(), vessel.mesh))
    vessel.notes.push_back("the mesh could not be cached in " + entry + "; it will be generated again by the next run");
  return vessel;
}

}  // namespace endovascular_sim::vessel
