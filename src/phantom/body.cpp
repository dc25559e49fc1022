#include "phantom/body.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/units.h"
#include "fluoroscopy/patient/body/body_model.h"
#include "fluoroscopy/patient/body/body_placement.h"
#include "phantom/solids.h"

namespace endovascular_sim::phantom
{
namespace
{

using Eigen::Vector3d;

constexpr int kAround = 12;  ///< points of the wall around a centreline

/** Ellipsoid in millimetres. */
Solid ellipsoidMm(const Vector3d& centre, const Vector3d& semi_axes)
{
  return ellipsoid(units::kMillimetre * centre, units::kMillimetre * semi_axes);
}

/** Heart of config/anatomies/plain.yaml with contrast medium in its chambers. */
void addHeart(std::vector<TissuePart>& parts)
{
  parts.push_back({Tissue::kFat, ellipsoidMm({20, -30, 150}, {85, 85, 90})});  // mediastinal and epicardial fat
  parts.push_back({Tissue::kMyocardium, ellipsoidMm({24, -34, 140}, {36, 36, 44})});
  parts.push_back({Tissue::kLeftVentricle, ellipsoidMm({30, -32, 140}, {20, 22, 32})});
  parts.push_back({Tissue::kRightVentricle, ellipsoidMm({4, -44, 142}, {12, 18, 28})});
  parts.push_back({Tissue::kLeftAtrium, ellipsoidMm({18, 14, 178}, {30, 20, 20})});
  parts.push_back({Tissue::kPulmonaryTrunk, [](const Vector3d& p)
                   {
                     const double axis = std::hypot(p.x() - 0.012, p.y() + 0.040) - 0.0125;
                     return std::max(axis, std::abs(p.z() - 0.222) - 0.018);
                   }});
}

bool isCoronary(const vessel::Anatomy& anatomy, const vessel::AnatomyChain& chain)
{
  const std::string& name = anatomy.branches[static_cast<std::size_t>(chain.branches.front())].name;
  return name == "left_anterior_descending" || name == "left_circumflex" || name == "right_coronary";
}

/** Point beside a chain: at an angle about its axis, and a distance from it. */
Vector3d besideAxis(const vessel::AnatomyChain& chain, std::size_t k, double angle, double distance)
{
  const Vector3d u = chain.tangents[k].cross(Vector3d(0.3, 0.5, 0.8)).normalized();
  const Vector3d w = chain.tangents[k].cross(u);
  return chain.points[k] + distance * (std::cos(angle) * u + std::sin(angle) * w);
}

/** Veins of 2.5 mm beside the left coronary arteries, winding about them at 0.5 to 1.2 mm from the wall. */
void addVeins(std::vector<TissuePart>& parts, const vessel::Anatomy& anatomy,
              const std::vector<vessel::AnatomyChain>& chains)
{
  constexpr std::size_t kLink = 8;
  for (const vessel::AnatomyChain& chain : chains)
  {
    const std::string& name = anatomy.branches[static_cast<std::size_t>(chain.branches.front())].name;
    if (!isCoronary(anatomy, chain) || name == "right_coronary")
      continue;
    std::vector<Vector3d> link;
    for (std::size_t k = 0; k < chain.points.size(); ++k)
      if (chain.arc[k] > 0.03 && chain.arc[k] < 0.09)
      {
        link.push_back(besideAxis(chain, k, chain.arc[k] / 0.02, chain.radii[k] + 0.0017));
        if (link.size() == kLink)
        {
          parts.push_back({Tissue::kVein, ballChain(link, 0.00125)});
          link = {link.back()};
        }
      }
    if (link.size() > 1)
      parts.push_back({Tissue::kVein, ballChain(link, 0.00125)});
  }
}

}  // namespace

std::optional<fluoroscopy::DensityVolume> bodyDensities(const vessel::Anatomy& anatomy,
                                                        const std::vector<vessel::AnatomyChain>& chains,
                                                        const Eigen::AlignedBox3d& box)
{
  vessel::Vessel vessel;
  vessel.centreline = vessel::anatomyCentreline(anatomy, chains);
  const fluoroscopy::body::BodyPlacement placement = fluoroscopy::body::placeBody(vessel);
  if (!placement.by_landmarks)
    return std::nullopt;
  const double spacing = fluoroscopy::BodySettings().spacing;
  image::VolumeGrid grid;
  grid.spacing.setConstant(spacing);
  grid.origin = box.min() - Vector3d::Constant(spacing);
  grid.size = ((box.sizes() / spacing).array().ceil().cast<int>() + 3).matrix();
  std::vector<Vector3d> wall;
  for (const vessel::AnatomyChain& chain : chains)
    for (std::size_t k = 0; k < chain.points.size(); ++k)
      for (int around = 0; around < kAround; ++around)
        wall.push_back(besideAxis(chain, k, 2.0 * units::kPi * around / kAround, chain.radii[k]));
  fluoroscopy::DensityVolume volume(grid, "phantom");
  fluoroscopy::drawBody(placement.frame, wall, fluoroscopy::BodySettings().seed, volume);
  return volume;
}

std::vector<TissuePart> heartParts(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains)
{
  std::vector<TissuePart> parts;
  if (anatomy.name != "plain")
    return parts;
  addHeart(parts);
  addVeins(parts, anatomy, chains);
  return parts;
}

std::vector<TissuePart> calcifiedPlaques(const vessel::Anatomy& anatomy,
                                         const std::vector<vessel::AnatomyChain>& chains)
{
  std::vector<TissuePart> plaques;
  for (const vessel::AnatomyChain& chain : chains)
  {
    if (!isCoronary(anatomy, chain))
      continue;
    for (double arc = 0.012; arc < 0.6 * chain.arc.back(); arc += 0.017)
    {
      std::size_t k = 0;
      while (chain.arc[k] < arc)
        ++k;
      plaques.push_back({Tissue::kCalcium, ball(besideAxis(chain, k, 311.0 * arc, chain.radii[k] + 0.0006), 0.0009)});
    }
  }
  return plaques;
}

}  // namespace endovascular_sim::phantom
