#include "segmentation/metal_check.h"

#include "common/text/format.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kMetal = 3000.0;     // HU; cortical bone and calcium lie below 2000
constexpr double kFarthest = 0.03;    ///< of metal whose streaks matter [m]
constexpr std::size_t kMost = 20000;  ///< metal voxels that are compared with the branches

/** Positions of metal voxels, evenly thinned out; grid frame [m]. */
std::vector<Eigen::Vector3d> metalOf(const Scan& scan)
{
  const image::Volume& volume = scan.volume();
  std::vector<std::size_t> voxels;
  for (std::size_t n = 0; n < volume.stored.size(); ++n)
    if (volume.scale * volume.stored[n] >= kMetal)
      voxels.push_back(n);
  const std::size_t stride = 1 + voxels.size() / kMost;
  const auto columns = static_cast<std::size_t>(volume.grid.size.x());
  const auto rows = static_cast<std::size_t>(volume.grid.size.y());
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t k = 0; k < voxels.size(); k += stride)
  {
    const std::size_t n = voxels[k];
    const Eigen::Vector3d index(static_cast<double>(n % columns), static_cast<double>(n / columns % rows),
                                static_cast<double>(n / (columns * rows)));
    positions.emplace_back(index.cwiseProduct(volume.grid.spacing));
  }
  return positions;
}

}  // namespace

std::vector<std::string> metalWarnings(const Scan& scan, const std::vector<LumenBranch>& branches)
{
  std::vector<std::string> warnings;
  if (scan.modality() != image::Modality::kCt)
    return warnings;
  const std::vector<Eigen::Vector3d> metal = metalOf(scan);
  for (const LumenBranch& branch : branches)
  {
    double nearest = kFarthest;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    std::size_t beside = 0;
    for (const Eigen::Vector3d& p : metal)
      for (std::size_t k = 0; k < branch.sections.size(); ++k)
        if (const double distance = (branch.sections[k].centre - p).norm(); distance < nearest)
        {
          nearest = distance;
          at = p;
          beside = k;
        }
    if (nearest >= kFarthest)
      continue;
    const Eigen::Vector3d place = 1e3 * scan.toPatient(at);
    const std::string text = formatted(
        ": metal at (%.1f, %.1f, %.1f) mm, %.0f mm from its axis at %.0f mm: streaks may displace the contour; "
        "check it in the straightened view, or use a reconstruction with metal artefact reduction",
        place.x(), place.y(), place.z(), 1e3 * nearest, 1e3 * branch.arc()[beside]);
    warnings.push_back(branch.name + text);
  }
  return warnings;
}

}  // namespace endovascular_sim::segmentation
