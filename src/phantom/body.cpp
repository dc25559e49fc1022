#include "phantom/body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "phantom/bones.h"
#include "phantom/solids.h"

namespace endovascular_sim::phantom
{
namespace
{

using Eigen::Vector3d;

constexpr double kMm = 1e-3;
/** Thickness of skin and subcutaneous fat [m]. */
constexpr double kSkin = 0.016;
/** Thickness of the muscles of the trunk [m]. */
constexpr double kMuscle = 0.014;

/** Ellipsoid in millimetres. */
Solid ellipsoidMm(const Vector3d& centre, const Vector3d& semi_axes)
{
  return ellipsoid(kMm * centre, kMm * semi_axes);
}

/** Outline of the trunk at a height. */
struct Outline
{
  double height, half_width, half_depth, middle;  ///< [mm]; middle: y of the centre
};

constexpr std::array<Outline, 9> kOutlines = {{{-260, 178, 112, -4},
                                               {-110, 176, 118, -4},
                                               {40, 156, 116, -6},
                                               {180, 166, 128, -6},
                                               {290, 178, 118, -4},
                                               {340, 168, 95, 2},
                                               {372, 82, 78, 10},
                                               {410, 62, 68, 14},
                                               {470, 62, 70, 14}}};

Outline outlineAt(double height)
{
  std::size_t k = 0;
  while (k + 2 < kOutlines.size() && kOutlines[k + 1].height < height)
    ++k;
  const Outline& a = kOutlines[k];
  const Outline& b = kOutlines[k + 1];
  const double t = std::clamp((height - a.height) / (b.height - a.height), 0.0, 1.0);
  const auto mix = [t](double u, double v) { return u + t * (v - u); };
  return {height, mix(a.half_width, b.half_width), mix(a.half_depth, b.half_depth), mix(a.middle, b.middle)};
}

/** Trunk, reduced by a depth below the skin. The factor bounds the slope of the outline. */
Solid trunk(double depth)
{
  return [depth](const Vector3d& p)
  {
    const Outline outline = outlineAt(p.z() / kMm);
    const Vector3d q(p.x() / (kMm * outline.half_width - depth),
                     (p.y() - kMm * outline.middle) / (kMm * outline.half_depth - depth), 0.0);
    const double least = kMm * std::min(outline.half_width, outline.half_depth) - depth;
    return 0.25 * (q.norm() - 1.0) * least;
  };
}

void addTrunk(std::vector<TissuePart>& parts)
{
  parts.push_back({Tissue::kFat, trunk(0.0)});
  parts.push_back({Tissue::kSoftTissue, trunk(kSkin)});
  parts.push_back({Tissue::kFat, intersection(trunk(kSkin + kMuscle), ellipsoidMm({0, -20, 40}, {150, 115, 160}))});
  parts.push_back({Tissue::kLung, intersection(trunk(kSkin + kMuscle), ellipsoidMm({-72, 0, 235}, {66, 105, 112}))});
  parts.push_back({Tissue::kLung, intersection(trunk(kSkin + kMuscle), ellipsoidMm({76, 4, 240}, {62, 102, 110}))});
  parts.push_back({Tissue::kOrgan, intersection(trunk(kSkin + kMuscle), ellipsoidMm({-62, -12, 112}, {88, 92, 68}))});
  parts.push_back({Tissue::kOrgan, ellipsoidMm({88, 36, 112}, {38, 52, 50})});  // spleen
  parts.push_back({Tissue::kOrgan, ellipsoidMm({62, 52, 62}, {28, 25, 55})});   // kidneys
  parts.push_back({Tissue::kOrgan, ellipsoidMm({-60, 52, 54}, {28, 25, 55})});
  parts.push_back({Tissue::kSoftTissue, ellipsoidMm({-8, -52, -10}, {95, 40, 85})});  // bowel
  parts.push_back({Tissue::kFat, ellipsoidMm({2, 6, 265}, {48, 62, 95})});            // upper mediastinum
}

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

std::vector<TissuePart> bodyParts(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains)
{
  std::vector<TissuePart> parts;
  if (anatomy.name != "plain")
    return {{Tissue::kFat, [](const Vector3d&) { return -1.0; }}};
  addTrunk(parts);
  addHeart(parts);
  addBones(parts);
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
