#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "contrast/cells/contrast_cells.h"
#include "geometry/polyline.h"
#include "geometry/triangle_mesh.h"
#include "vessel/anatomy/anatomy.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/anatomy/implicit_vessel.h"
#include "vessel/anatomy/implicit_vessel_remesh.h"
#include "vessel/anatomy/iso_surface.h"
#include "vessel/anatomy/tube.h"
#include "vessel/centreline/centreline_extraction.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/model/vessel.h"
#include "vessel/repair/mesh_repair.h"
#include "vessel/repair/remesh.h"

namespace endovascular_sim::contrast
{

/** Cells of a centreline, 0.45 radii long, at least 2.5 mm. A branch begins a radius of its parent behind its first
 * point. */
inline ContrastCells cellsOf(const vessel::CentrelineTree& tree)
{
  ContrastCells cells;
  std::vector<std::vector<int>> of_branch(tree.branches.size());
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const vessel::CentrelineBranch& branch = tree.branches[b];
    const geometry::Polyline line(branch.points);
    double begin = 0.0;
    int parent = -1;
    if (branch.parent >= 0)
    {
      const auto p = static_cast<std::size_t>(branch.parent);
      const geometry::Polyline trunk(tree.branches[p].points);
      const double on_parent = trunk.nearest(branch.points.front()).arc;
      if (trunk.length() - on_parent > 2e-3)
        begin = std::min(trunk.interpolate(tree.branches[p].radii, on_parent), 0.5 * line.length());
      parent = of_branch[p].back();
      for (const int k : of_branch[p])
        if (cells[static_cast<std::size_t>(k)].end >= on_parent)
        {
          parent = k;
          break;
        }
    }
    double widest = 0.0;
    for (const double radius : branch.radii)
      widest += radius / static_cast<double>(branch.radii.size());
    const int count =
        std::max(1, static_cast<int>(std::ceil((line.length() - begin) / std::max(2.5e-3, 0.45 * widest))));
    for (int k = 0; k < count; ++k)
    {
      cells.push_back({static_cast<int>(b), begin + (line.length() - begin) * k / count,
                       begin + (line.length() - begin) * (k + 1) / count, parent});
      parent = static_cast<int>(cells.size()) - 1;
      of_branch[b].push_back(parent);
    }
  }
  return cells;
}

/** Vessel and its cells. */
struct DividedVessel
{
  std::string name;
  geometry::TriangleMesh mesh;
  vessel::CentrelineTree centreline;
  ContrastCells cells;
};

inline DividedVessel dividedVessel(std::string name, geometry::TriangleMesh mesh, vessel::CentrelineTree centreline)
{
  ContrastCells cells = cellsOf(centreline);
  return {std::move(name), std::move(mesh), std::move(centreline), std::move(cells)};
}

inline const DividedVessel& generatedVessel(const std::string& name)
{
  static std::vector<std::pair<std::string, DividedVessel>> known;
  for (const auto& [other, vessel] : known)
    if (other == name)
      return vessel;
  const vessel::Vessel vessel = vessel::loadAnatomy(PROJECT_DIR "/config/anatomies/" + name + ".yaml");
  known.reserve(8);
  known.emplace_back(name, dividedVessel(name, vessel.mesh, vessel.centreline));
  return known.back().second;
}

/** Segmented vessel of ENDOVASCULAR_DATA_DIR with an extracted centreline; null without it. */
inline const DividedVessel* segmentedVessel(const std::string& file)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  const std::string path = folder == nullptr ? "" : std::string(folder) + "/" + file;
  if (path.empty() || !std::filesystem::exists(path))
    return nullptr;
  static std::vector<std::pair<std::string, DividedVessel>> known;
  for (const auto& [other, vessel] : known)
    if (other == file)
      return &vessel;
  geometry::TriangleMesh mesh = vessel::repairMesh(vessel::readMesh(path, 1e-3), path).mesh;
  vessel::CentrelineTree centreline = vessel::extractCentreline(mesh);
  known.reserve(8);
  known.emplace_back(file, dividedVessel(file, std::move(mesh), std::move(centreline)));
  return &known.back().second;
}

/** Generated vessel with a loop. */
inline const DividedVessel& vesselWithLoop()
{
  static const DividedVessel kVessel = []
  {
    const vessel::Anatomy anatomy = vessel::readAnatomy(TEST_DATA_DIR "/bypass.yaml");
    const std::vector<vessel::AnatomyChain> chains = vessel::sampleChains(anatomy);
    const vessel::ImplicitVessel field(anatomy, chains);
    return dividedVessel("bypass", vessel::remesh(vessel::isoSurface(field), field),
                         vessel::anatomyCentreline(anatomy, chains));
  }();
  return kVessel;
}

/** Bent tube of 3 mm radius, 32 facets around. */
inline DividedVessel bentTube()
{
  vessel::TubeShape shape;
  shape.radius = 3e-3;
  shape.facet_length = 1e-3;
  shape.pieces = {{0.02, 0.0, 0.0}, {0.03, 100.0, 0.3}, {0.01, 0.0, 0.0}};
  return dividedVessel("tube", vessel::tubeMesh(shape), vessel::tubeCentreline(shape));
}

}  // namespace endovascular_sim::contrast
