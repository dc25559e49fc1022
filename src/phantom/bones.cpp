#include "phantom/bones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "phantom/solids.h"

namespace endovascular_sim::phantom
{
namespace
{

using Eigen::Vector3d;

constexpr double kMm = 1e-3;

Solid ellipsoidMm(const Vector3d& centre, const Vector3d& semi_axes)
{
  return ellipsoid(kMm * centre, kMm * semi_axes);
}

/** Adds a bone with a cortex. */
void addBone(std::vector<TissuePart>& parts, const Solid& solid, double cortex)
{
  parts.push_back({Tissue::kCortex, solid});
  parts.push_back({Tissue::kMarrow, [solid, cortex](const Vector3d& p) { return solid(p) + cortex; }});
}

/** Axis of the vertebral bodies, behind the aorta, and their radius. */
struct SpinePoint
{
  double height, x, y, radius;  ///< [mm]
};

constexpr std::array<SpinePoint, 9> kSpine = {{{-40, 0, 40, 22},
                                               {0, 0, 37, 22},
                                               {88, -4, 56, 20},
                                               {130, -6, 62, 18},
                                               {178, -6, 60, 17},
                                               {222, -6, 60, 17},
                                               {262, -4, 60, 16},
                                               {340, 0, 50, 14},
                                               {450, 0, 30, 11}}};

SpinePoint spineAt(double height)
{
  std::size_t k = 0;
  while (k + 2 < kSpine.size() && kSpine[k + 1].height < height)
    ++k;
  const SpinePoint& a = kSpine[k];
  const SpinePoint& b = kSpine[k + 1];
  const double t = std::clamp((height - a.height) / (b.height - a.height), 0.0, 1.0);
  return {height, a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.radius + t * (b.radius - a.radius)};
}

void addSpine(std::vector<TissuePart>& parts)
{
  double height = -30.0;
  while (height < 440.0)
  {
    const double pitch = height < 110.0 ? 34.0 : height < 320.0 ? 24.0 : 18.0;
    const SpinePoint centre = spineAt(height);
    const double half = 0.5 * pitch - 2.5;  // a disc of 5 mm between the bodies
    const Vector3d at(kMm * centre.x, kMm * centre.y, kMm * height);
    const double radius = kMm * centre.radius;
    const auto column = [at, radius](const Vector3d& p) { return std::hypot(p.x() - at.x(), p.y() - at.y()) - radius; };
    const auto slab = [at](double thickness)
    { return [at, thickness](const Vector3d& p) { return std::abs(p.z() - at.z()) - thickness; }; };
    parts.push_back({Tissue::kDisc, intersection(column, slab(kMm * 0.5 * pitch))});
    addBone(parts, intersection(column, slab(kMm * half)), 1.5 * kMm);
    const double back = centre.y + centre.radius;
    addBone(parts, ellipsoidMm({centre.x, back + 26, height - 6}, {5, 18, 9}), 1.5 * kMm);  // spinous process
    for (const double side : {-1.0, 1.0})
    {
      addBone(parts, ellipsoidMm({centre.x + side * 13, back + 8, height}, {5, 11, 8}), 1.5 * kMm);
      addBone(parts, ellipsoidMm({centre.x + side * 28, back + 10, height}, {18, 5, 6}), 1.5 * kMm);
    }
    height += pitch;
  }
}

/** Rib: an arc of an ellipse around the chest that descends to the front.
 *  @param height of its head [m] */
Solid rib(double height, double half_width, double half_depth, double side)
{
  constexpr double kThickness = 0.0055;
  constexpr double kDrop = 0.055;
  constexpr double kMiddle = -0.006;  // y of the centre of the ellipse
  return [=](const Vector3d& p)
  {
    const Vector3d q(side * p.x() / half_width, (p.y() - kMiddle) / half_depth, 0.0);
    const double off = (q.norm() - 1.0) * half_depth;
    const double away = std::max({std::abs(off), p.z() - height, height - kDrop - p.z()});
    if (away > 0.03 || side * p.x() < 0.0)
      return 0.5 * std::max(away, 0.03) - kThickness;
    const double angle = std::clamp(std::atan2(q.x(), q.y()), 0.2, 2.5);  // 0 at the back
    const Vector3d axis(side * half_width * std::sin(angle), kMiddle + half_depth * std::cos(angle),
                        height - kDrop * 0.5 * (1.0 - std::cos(angle)));
    return 0.5 * ((p - axis).norm() - kThickness);
  };
}

void addRibs(std::vector<TissuePart>& parts)
{
  for (int k = 0; k < 10; ++k)
  {
    const double height = 0.140 + 0.023 * k;
    const double share = k < 6 ? 1.0 : 1.0 - 0.10 * (k - 5);  // the upper ribs are shorter
    for (const double side : {-1.0, 1.0})
    {
      const Solid bone = rib(height, 0.142 * share, 0.104 * share, side);
      parts.push_back({Tissue::kCortex, bone});
      parts.push_back({Tissue::kMarrow, [bone](const Vector3d& p) { return bone(p) + 0.5 * 0.0015; }});
    }
  }
  addBone(parts, ellipsoidMm({0, -109, 225}, {17, 6, 70}), 1.5 * kMm);  // sternum
}

void addPelvis(std::vector<TissuePart>& parts)
{
  addBone(parts, ellipsoidMm({0, 64, -62}, {42, 20, 48}), 2.0 * kMm);  // sacrum
  for (const double side : {-1.0, 1.0})
  {
    const Solid wing = shell(ellipsoidMm({0, 2, -48}, {132, 84, 110}), 9 * kMm);
    const auto region = [side](const Vector3d& p)
    { return std::max(0.048 - side * p.x(), p.z() - 0.012 - 0.1 * p.y()) / 1.5; };
    addBone(parts, intersection(intersection(wing, region), ellipsoidMm({side * 92, 22, -62}, {60, 72, 75})),
            2.0 * kMm);
    addBone(parts, ellipsoidMm({side * 46, -22, -172}, {40, 9, 10}), 2.0 * kMm);  // pubis
    addBone(parts, ball(kMm * Vector3d(side * 94, 12, -155), 0.024), 2.0 * kMm);  // femoral head
    std::vector<Vector3d> neck;
    for (int k = 0; k <= 10; ++k)
      neck.emplace_back(kMm * Vector3d(side * (98.0 + 3.4 * k), 14.0, -160.0 - 2.6 * k));
    addBone(parts, ballChain(neck, 0.015), 2.0 * kMm);
    std::vector<Vector3d> shaft;
    for (int k = 0; k <= 20; ++k)
      shaft.emplace_back(kMm * Vector3d(side * 134.0, 14.0, -180.0 - 5.0 * k));
    addBone(parts, ballChain(shaft, 0.015), 3.0 * kMm);
  }
}

}  // namespace

void addBones(std::vector<TissuePart>& parts)
{
  addSpine(parts);
  addRibs(parts);
  addPelvis(parts);
}

}  // namespace endovascular_sim::phantom
