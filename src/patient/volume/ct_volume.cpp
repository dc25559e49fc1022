#include "patient/volume/ct_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/error.h"
#include "common/text/format.h"
#include "patient/volume/hounsfield.h"
#include "patient/volume/lumen_mask.h"

namespace endovascular_sim::patient
{
namespace
{

/** Number of voxels along each axis that become one. */
Eigen::Vector3i blockOf(const image::VolumeGrid& grid)
{
  Eigen::Vector3i block;
  for (int axis = 0; axis < 3; ++axis)
    block[axis] = std::max(1, static_cast<int>(std::floor(kCtSpacing / grid.spacing[axis] + 1e-9)));
  return block;
}

/** Grid of the blocks in the patient frame. An incomplete last block is omitted. */
image::VolumeGrid gridOf(const image::VolumeGrid& ct, const Eigen::Vector3i& block,
                         const Eigen::Isometry3d& patient_from_ct)
{
  image::VolumeGrid grid;
  grid.size = ct.size.cwiseQuotient(block);
  grid.spacing = ct.spacing.cwiseProduct(block.cast<double>());
  grid.origin = patient_from_ct * ct.position(0.5 * (block.cast<double>().array() - 1.0).matrix());
  grid.axes = patient_from_ct.linear() * ct.axes;
  return grid;
}

Density meanDensity(const image::Volume& ct, const Eigen::Vector3i& first, const Eigen::Vector3i& block)
{
  Density sum;
  for (int k = 0; k < block.z(); ++k)
    for (int j = 0; j < block.y(); ++j)
      for (int i = 0; i < block.x(); ++i)
      {
        const Density density = densityFromHounsfield(ct.at(first.x() + i, first.y() + j, first.z() + k));
        sum.tissue += density.tissue;
        sum.bone += density.bone;
      }
  const double voxels = block.prod();
  return {sum.tissue / voxels, sum.bone / voxels};
}

/** Share of the vertices inside the outermost centres of a grid. */
double shareInside(const geometry::TriangleMesh& mesh, const image::VolumeGrid& grid)
{
  std::size_t inside = 0;
  const Eigen::Array3d last = (grid.size.array() - 1).cast<double>();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
  {
    const Eigen::Array3d index = grid.index(vertex).array();
    inside += (index >= 0.0).all() && (index <= last).all() ? 1 : 0;
  }
  return mesh.vertices.empty() ? 1.0 : static_cast<double>(inside) / static_cast<double>(mesh.vertices.size());
}

std::string describe(const Eigen::AlignedBox3d& box)
{
  return formatted("x %.3f to %.3f, y %.3f to %.3f, z %.3f to %.3f m", box.min().x(), box.max().x(), box.min().y(),
                   box.max().y(), box.min().z(), box.max().z());
}

/** Note on the position of the vessel in the CT. */
std::string requireOverlap(const geometry::TriangleMesh& lumen, const image::VolumeGrid& grid,
                           const std::string& source)
{
  const double share = shareInside(lumen, grid);
  if (share == 0.0)
  {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : lumen.vertices)
      box.extend(vertex);
    throw InputError(source, "registration",
                     "no part of the vessel lies inside the CT; the vessel covers " + describe(box) + ", the CT " +
                         describe(grid.bounds()) +
                         " of the patient frame; correct rotation and "
                         "translation of the CT");
  }
  return formatted("%.0f %% of the vessel's wall lies inside the CT", 100.0 * share);
}

}  // namespace

PatientVolume ctVolume(const image::Volume& ct, const Eigen::Isometry3d& patient_from_ct,
                       const geometry::TriangleMesh& lumen, const std::string& source)
{
  if (ct.modality != image::Modality::kCt)
    throw InputError(source, "modality", "is not CT; densities require Hounsfield units");
  const Eigen::Vector3i block = blockOf(ct.grid);
  DensityVolume volume(gridOf(ct.grid, block, patient_from_ct), source);
  const std::string note = requireOverlap(lumen, volume.grid(), source);
  const Eigen::Vector3i size = volume.grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
        volume.set(i, j, k, meanDensity(ct, Eigen::Vector3i(i, j, k).cwiseProduct(block), block));
  replaceByBlood(volume, lumenMask(volume.grid(), lumen));
  return {std::make_shared<const DensityVolume>(std::move(volume)), {source + ": " + note}};
}

}  // namespace endovascular_sim::patient
