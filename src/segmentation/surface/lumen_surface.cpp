#include "segmentation/surface/lumen_surface.h"

#include "common/numerics/parallel_for.h"
#include "segmentation/surface/lattice_field.h"
#include "segmentation/surface/lattice_surface.h"

namespace endovascular_sim::segmentation
{

geometry::TriangleMesh lumenSurface(const std::vector<LumenBranch>& branches, const SurfaceSettings& settings,
                                    int* components)
{
  const LatticeField field(branches, settings.spacing, settings.blend, threadCount(settings.threads));
  return latticeSurface(field, components);
}

int genusOf(const geometry::TriangleMesh& mesh)
{
  const auto vertices = static_cast<long>(mesh.vertices.size());
  const auto triangles = static_cast<long>(mesh.triangles.size());
  return static_cast<int>((2 - (vertices - 3 * triangles / 2 + triangles)) / 2);
}

}  // namespace endovascular_sim::segmentation
