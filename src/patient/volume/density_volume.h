#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "image/volume_grid.h"

namespace endovascular_sim::patient
{

/** Mass of soft tissue and of cortical bone per volume of a mixture [kg/m³]. Water and blood count as tissue. */
struct Density
{
  double tissue = 0.0;
  double bone = 0.0;
};

/** Densities of soft tissue and bone on a lattice, with trilinear interpolation between voxel centres and air beyond
 * the outermost centres.
 *
 *  A voxel takes two bytes: tissue in steps of 5 kg/m³ up to 1275 kg/m³, bone in steps of 8 kg/m³ up to 2040 kg/m³. The
 *  steps contain the densities of blood (1060), muscle (1050), fat (930) and of inflated lung (260) exactly. */
class DensityVolume
{
public:
  static constexpr double kTissueStep = 5.0;  ///< [kg/m³]
  static constexpr double kBoneStep = 8.0;    ///< [kg/m³]
  static constexpr int kMaxSide = 2048;       ///< most voxels along an axis
  static constexpr std::size_t kMaxVoxels = std::size_t{1} << 30;

  /** Volume of air.
   *  @throws InputError for a grid with fewer than 2 or too many voxels, a spacing outside of 0.05 to 50 mm, or axes
   * that are not orthonormal
   *  @param source name of the volume in errors */
  explicit DensityVolume(const image::VolumeGrid& grid, const std::string& source = "density volume");

  const image::VolumeGrid& grid() const { return grid_; }

  /** Memory of the voxels [bytes]. */
  std::size_t memory() const { return 2 * voxels_.size(); }

  Density at(int x, int y, int z) const;

  /** Stores the nearest representable densities. */
  void set(int x, int y, int z, const Density& density);

  /** Trilinear interpolation at a point of the patient frame [m]. */
  Density interpolate(const Eigen::Vector3d& point) const;

  /** Voxels in storage order: tissue steps in the low byte, bone steps in the high byte. */
  const std::vector<std::uint16_t>& voxels() const { return voxels_; }
  std::vector<std::uint16_t>& voxels() { return voxels_; }

  static std::uint16_t encode(const Density& density);
  static Density decode(std::uint16_t voxel);

private:
  image::VolumeGrid grid_;
  std::vector<std::uint16_t> voxels_;
};

}  // namespace endovascular_sim::patient
