#include "fluoroscopy/motion/diaphragm_field.h"

#include <algorithm>

namespace endovascular_sim::fluoroscopy
{
namespace
{

// Positions and sizes of the domes of the procedural body, for a heart with an axis of this length [m].
constexpr double kAxis = 0.13;
constexpr double kAside = 0.058;        // top of a dome from the base of the heart, to the side
constexpr double kRightHeight = 0.025;  // above the apex
constexpr double kLeftHeight = 0.013;   // above the apex
constexpr double kHalfWidth = 0.056;
constexpr double kHalfDepth = 0.068;
constexpr double kDescent = 0.033;   // below the top at rest, to where the whole displacement counts
constexpr double kAbove = 0.010;     // above the top at rest, to where the whole displacement counts
constexpr double kFade = 0.11;       // height of the fades
constexpr double kFullSquare = 0.2;  // ρ² up to which the whole displacement counts

/** 1 for t ≤ 0, 0 for t ≥ 1, C² between. */
double fade(double t)
{
  t = std::clamp(t, 0.0, 1.0);
  return 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
}

}  // namespace

Eigen::AlignedBox3d DiaphragmField::Dome::box() const
{
  return {Eigen::Vector3d(top.x() - half_width, top.y() - half_depth, low - fade),
          Eigen::Vector3d(top.x() + half_width, top.y() + half_depth, high + fade)};
}

DiaphragmField::DiaphragmField(const motion::HeartFrame& frame) : heart_(frame.fade)
{
  const double scale = frame.length / kAxis;
  for (std::size_t side = 0; side < domes_.size(); ++side)
  {
    const double left = side == 0 ? 1.0 : -1.0;
    Dome& dome = domes_[side];
    dome.top = Eigen::Vector3d(frame.base.x() + left * scale * kAside, frame.base.y(),
                               frame.apex().z() + scale * (side == 0 ? kLeftHeight : kRightHeight));
    dome.half_width = scale * kHalfWidth;
    dome.half_depth = scale * kHalfDepth;
    dome.low = dome.top.z() - scale * kDescent;
    dome.high = dome.top.z() + scale * kAbove;
    dome.fade = scale * kFade;
  }
}

double DiaphragmField::weight(const Eigen::Vector3d& point) const
{
  for (const Dome& dome : domes_)  // their boxes are disjoint
  {
    const double across = (point.x() - dome.top.x()) / dome.half_width;
    const double deep = (point.y() - dome.top.y()) / dome.half_depth;
    const double square = across * across + deep * deep;
    const double height = std::max(dome.low - point.z(), point.z() - dome.high);
    if (!(square < 1.0) || !(height < dome.fade))
      continue;
    const double core = heart_.core * heart_.core;
    const double heart = fade(((point - heart_.centre).squaredNorm() - core) / (heart_.reach * heart_.reach - core));
    return (1.0 - heart) * fade((square - kFullSquare) / (1.0 - kFullSquare)) * fade(height / dome.fade);
  }
  return 0.0;
}

}  // namespace endovascular_sim::fluoroscopy
