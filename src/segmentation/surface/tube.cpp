#include "segmentation/surface/tube.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{

// Two pieces beyond the ends hold the points outside of the flat ends.
Tube::Tube(const std::vector<Section>& sections, double margin)
{
  sections_.reserve(sections.size() + 2);
  sections_.push_back(sections.front());
  sections_.front().centre -= margin * sections.front().tangent;
  sections_.insert(sections_.end(), sections.begin(), sections.end());
  sections_.push_back(sections.back());
  sections_.back().centre += margin * sections.back().tangent;
  for (std::size_t k = 0; k + 1 < sections_.size(); ++k)
  {
    const Section& a = sections_[k];
    const Section& b = sections_[k + 1];
    const double widest =
        std::max(*std::max_element(a.radii.begin(), a.radii.end()), *std::max_element(b.radii.begin(), b.radii.end()));
    pieces_.push_back({k, 0.5 * (a.centre + b.centre), widest + margin + 0.5 * (b.centre - a.centre).norm()});
  }
}

bool Tube::isNear(const Piece& piece, const Eigen::Vector3d& centre, double radius) const
{
  const Section& a = sections_[piece.first];
  const Section& b = sections_[piece.first + 1];
  return (centre - a.centre).dot(a.tangent) >= -radius && (centre - b.centre).dot(b.tangent) < radius;
}

void Tube::sample(const Piece& piece, const Eigen::Vector3d& p, Sample& result) const
{
  const Section& a = sections_[piece.first];
  const Section& b = sections_[piece.first + 1];
  const double before = (p - a.centre).dot(a.tangent);
  const double after = (p - b.centre).dot(b.tangent);
  if (before < 0.0 || after >= 0.0 || (p - piece.centre).squaredNorm() > piece.reach * piece.reach)
    return;
  const double t = before / (before - after);
  const Eigen::Vector3d from = p - a.centre - t * (b.centre - a.centre);
  const Eigen::Vector3d u = a.u + t * (b.u - a.u);
  const Eigen::Vector3d w = a.w + t * (b.w - a.w);
  const double x = from.dot(u);
  const double y = from.dot(w);
  const double angle = std::atan2(y, x);
  const double radius = a.radiusAt(angle) + t * (b.radiusAt(angle) - a.radiusAt(angle));
  const double off_axis = std::hypot(x, y);
  double distance = off_axis - radius;
  if (piece.first == 0)
    distance = std::max(distance, -after);
  else if (piece.first + 2 == sections_.size())
    distance = std::max(distance, before);
  if (distance >= result.distance)
    return;
  result.distance = distance;
  result.radius = radius;
  result.outward = off_axis > 0.0 ? Eigen::Vector3d((x * u + y * w) / off_axis) : Eigen::Vector3d(u);
}

Tube::Sample Tube::at(const Eigen::Vector3d& p) const
{
  Sample result;
  for (const Piece& piece : pieces_)
    sample(piece, p, result);
  return result;
}

}  // namespace endovascular_sim::segmentation
