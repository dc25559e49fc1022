#include "intervention/stent_placement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/polyline.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kSleeveSpacing = 0.5e-3;  // spacing of the points on the sleeve's axis [m]
constexpr double kZigzag = 0.8;            // axial length of a strut, relative to the length of its ring

}  // namespace

StentPlacement::StentPlacement(instrument::Stent stent, const instrument::Balloon& balloon, double opening_pressure)
  : stent_(std::move(stent)),
    middle_from_tip_(balloon.from_tip + 0.5 * balloon.length),
    opening_pressure_(opening_pressure),
    inner_diameter_(stent_.crimped_diameter - 2.0 * stent_.strut_thickness)
{
}

StentPlacement::State StentPlacement::update(const ShaftLine& shaft, double pressure, double balloon_diameter)
{
  if (state_ == State::kPlaced || state_ == State::kLost)
    return state_;
  if (pressure >= opening_pressure_ && balloon_diameter > inner_diameter_)
  {
    state_ = State::kExpanding;
    over_expanded_ = over_expanded_ || balloon_diameter > stent_.largestDiameter();
    inner_diameter_ = std::max(inner_diameter_, std::min(balloon_diameter, stent_.largestDiameter()));
  }
  if (state_ == State::kExpanding && balloon_diameter < stent_.afterRecoil(inner_diameter_))
  {
    // The stent keeps the pose of the last step in which the balloon filled it.
    state_ = State::kPlaced;
    inner_diameter_ = stent_.afterRecoil(inner_diameter_);
  }
  alignWith(shaft);
  return state_;
}

void StentPlacement::dislodge()
{
  if (state_ == State::kCrimped)
    state_ = State::kLost;
}

void StentPlacement::release()
{
  if (state_ == State::kExpanding)
    state_ = State::kPlaced;
}

void StentPlacement::alignWith(const ShaftLine& shaft)
{
  const double length = stent_.lengthAt(inner_diameter_);
  const int count = std::max(2, static_cast<int>(std::ceil(length / kSleeveSpacing)));
  sleeve_.axis.clear();
  for (int k = 0; k <= count; ++k)
    sleeve_.axis.push_back(shaft.at(middle_from_tip_ + length * (static_cast<double>(k) / count - 0.5)));
  sleeve_.radii.assign(sleeve_.axis.size(), 0.5 * outerDiameter());
}

std::vector<std::vector<Eigen::Vector3d>> stentStruts(const RoundBody& sleeve, int crowns, double ring_length)
{
  std::vector<std::vector<Eigen::Vector3d>> rings;
  if (sleeve.axis.size() < 2)
    return rings;
  const geometry::Polyline axis(sleeve.axis);
  const int count = std::max(1, static_cast<int>(std::lround(axis.length() / ring_length)));
  const double spacing = axis.length() / count;
  const double radius = sleeve.radii.front();
  Eigen::Vector3d side = axis.tangentAt(0.0).unitOrthogonal();
  for (int ring = 0; ring < count; ++ring)
  {
    const double middle = (ring + 0.5) * spacing;
    const Eigen::Vector3d along = axis.tangentAt(middle);
    side = (side - side.dot(along) * along).normalized();  // parallel transport along the axis
    std::vector<Eigen::Vector3d> line;
    for (int k = 0; k <= 2 * crowns; ++k)
    {
      const double angle = M_PI * k / crowns;
      const double arc = middle + (k % 2 == 0 ? -0.5 : 0.5) * kZigzag * spacing;
      line.emplace_back(axis.at(arc) + radius * (Eigen::AngleAxisd(angle, along) * side));
    }
    rings.push_back(std::move(line));
  }
  return rings;
}

}  // namespace endovascular_sim::intervention
