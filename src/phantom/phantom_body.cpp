#include "phantom/phantom_body.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "common/units.h"
#include "patient/body/body_placement.h"

namespace endovascular_sim::phantom
{
namespace
{

using Eigen::Vector3d;
using patient::BodyPart;
using patient::Point;
using patient::Tissue;

constexpr int kAround = 12;  ///< points of the wall around a centreline

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

Point inMillimetres(const Vector3d& p)
{
  return (p / units::kMillimetre).cast<float>();
}

image::VolumeGrid gridAround(const Eigen::AlignedBox3d& box, double spacing)
{
  image::VolumeGrid grid;
  grid.spacing.setConstant(spacing);
  grid.origin = box.min() - Vector3d::Constant(spacing);
  grid.size = ((box.sizes() / spacing).array().ceil().cast<int>() + 3).matrix();
  return grid;
}

}  // namespace

std::optional<PhantomBody> phantomBody(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains,
                                       const Eigen::AlignedBox3d& box)
{
  vessel::Vessel vessel;
  vessel.centreline = vessel::anatomyCentreline(anatomy, chains);
  const patient::BodyPlacement placement = patient::placeBody(vessel);
  if (!placement.by_landmarks)
    return std::nullopt;
  std::vector<Vector3d> wall;
  for (const vessel::AnatomyChain& chain : chains)
    for (std::size_t k = 0; k < chain.points.size(); ++k)
      for (int around = 0; around < kAround; ++around)
        wall.push_back(besideAxis(chain, k, 2.0 * units::kPi * around / kAround, chain.radii[k]));
  const patient::BodySettings settings;
  const patient::BodyMap map = patient::bodyMap(placement.frame, wall, settings.seed);
  PhantomBody body{patient::DensityVolume(gridAround(box, settings.spacing), "phantom"), {}, map.frame};
  patient::voxelise(map.parts, map.frame, map.seed, body.densities);
  for (const BodyPart& part : map.parts)
    if (patient::hasContrast(part.material.tissue))
      body.contrast.push_back(part);
  return body;
}

std::vector<BodyPart> cardiacVeins(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains)
{
  constexpr std::size_t kLink = 8;
  std::vector<BodyPart> veins;
  for (const vessel::AnatomyChain& chain : chains)
  {
    const std::string& name = anatomy.branches[static_cast<std::size_t>(chain.branches.front())].name;
    if (!isCoronary(anatomy, chain) || name == "right_coronary")
      continue;
    std::vector<std::pair<Point, float>> link;
    const auto add = [&]
    {
      veins.push_back({patient::replacing(Tissue::kCardiacVein), {}, {}});
      patient::addChain(veins.back().solids, link);
      link = {link.back()};
    };
    for (std::size_t k = 0; k < chain.points.size(); ++k)
      if (chain.arc[k] > 0.03 && chain.arc[k] < 0.09)
      {
        link.emplace_back(inMillimetres(besideAxis(chain, k, chain.arc[k] / 0.02, chain.radii[k] + 0.0017)), 1.25F);
        if (link.size() == kLink)
          add();
      }
    if (link.size() > 1)
      add();
  }
  return veins;
}

std::vector<BodyPart> calcifiedPlaques(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains)
{
  std::vector<BodyPart> plaques;
  for (const vessel::AnatomyChain& chain : chains)
  {
    if (!isCoronary(anatomy, chain))
      continue;
    for (double arc = 0.012; arc < 0.6 * chain.arc.back(); arc += 0.017)
    {
      std::size_t k = 0;
      while (chain.arc[k] < arc)
        ++k;
      const Point centre = inMillimetres(besideAxis(chain, k, 311.0 * arc, chain.radii[k] + 0.0006));
      plaques.push_back(
          {patient::replacing(Tissue::kCalcium), {patient::ellipsoid(centre, Point::Constant(0.9F))}, {}});
    }
  }
  return plaques;
}

}  // namespace endovascular_sim::phantom
