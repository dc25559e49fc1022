#include "contact/segment_pair.h"

#include <algorithm>

namespace endovascular_sim::contact
{

SegmentPair closestPointsOfSegments(const Eigen::Vector3d& p1, const Eigen::Vector3d& q1, const Eigen::Vector3d& p2,
                                    const Eigen::Vector3d& q2)
{
  const Eigen::Vector3d d1 = q1 - p1;
  const Eigen::Vector3d d2 = q2 - p2;
  const Eigen::Vector3d r = p1 - p2;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  const double c = d1.dot(r);
  const double b = d1.dot(d2);
  const double determinant = a * e - b * b;
  const auto clamp = [](double value) { return std::max(0.0, std::min(1.0, value)); };
  SegmentPair pair;
  pair.first = determinant > 1e-12 * a * e ? clamp((b * f - c * e) / determinant) : 0.5;
  pair.second = (b * pair.first + f) / e;
  if (pair.second < 0.0)
  {
    pair.second = 0.0;
    pair.first = clamp(-c / a);
  }
  else if (pair.second > 1.0)
  {
    pair.second = 1.0;
    pair.first = clamp((b - c) / a);
  }
  return pair;
}

}  // namespace endovascular_sim::contact
