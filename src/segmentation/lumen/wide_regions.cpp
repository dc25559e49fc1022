#include "segmentation/lumen/wide_regions.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kCoarse = 0.9e-3;  ///< edge of a coarse voxel [m]
constexpr float kFar = 1e6F;        ///< squared distance without a marked point [m²]

/** Lower envelope of parabolas along one line of samples. */
class LineTransform
{
public:
  explicit LineTransform(std::size_t longest) : values_(longest), apexes_(longest), bounds_(longest + 1) {}

  void run(float* line, std::size_t stride, int n, double spacing)
  {
    const double square = spacing * spacing;
    int last = -1;
    for (int q = 0; q < n; ++q)
    {
      values_[static_cast<std::size_t>(q)] = line[static_cast<std::size_t>(q) * stride];
      if (values_[static_cast<std::size_t>(q)] >= kFar)
        continue;
      double s = -1e30;
      while (last >= 0)
      {
        const int v = apexes_[static_cast<std::size_t>(last)];
        s = (values_[static_cast<std::size_t>(q)] - values_[static_cast<std::size_t>(v)]) / (2.0 * square * (q - v)) +
            0.5 * (q + v);
        if (s > bounds_[static_cast<std::size_t>(last)])
          break;
        --last;
      }
      if (last < 0)
        s = -1e30;
      ++last;
      apexes_[static_cast<std::size_t>(last)] = q;
      bounds_[static_cast<std::size_t>(last)] = s;
    }
    if (last < 0)
      return;
    bounds_[static_cast<std::size_t>(last) + 1] = 1e30;
    std::size_t k = 0;
    for (int q = 0; q < n; ++q)
    {
      while (bounds_[k + 1] < q)
        ++k;
      const double d = spacing * (q - apexes_[k]);
      line[static_cast<std::size_t>(q) * stride] =
          static_cast<float>(d * d + values_[static_cast<std::size_t>(apexes_[k])]);
    }
  }

private:
  std::vector<double> values_;
  std::vector<int> apexes_;
  std::vector<double> bounds_;
};

}  // namespace

void squaredDistances(std::vector<float>& squared, const Eigen::Vector3i& size, const Eigen::Vector3d& spacing)
{
  const auto nx = static_cast<std::size_t>(size.x());
  const auto ny = static_cast<std::size_t>(size.y());
  const auto nz = static_cast<std::size_t>(size.z());
  LineTransform transform(static_cast<std::size_t>(size.maxCoeff()));
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j)
      transform.run(&squared[(k * ny + j) * nx], 1, size.x(), spacing.x());
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t i = 0; i < nx; ++i)
      transform.run(&squared[k * ny * nx + i], nx, size.y(), spacing.y());
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i)
      transform.run(&squared[j * nx + i], nx * ny, size.z(), spacing.z());
}

WideRegions::WideRegions(const Scan& scan, double threshold, double radius)
{
  Eigen::Vector3i factor;
  for (int axis = 0; axis < 3; ++axis)
  {
    factor[axis] = std::max(1, static_cast<int>(std::lround(kCoarse / scan.spacing()[axis])));
    size_[axis] = scan.size()[axis] / factor[axis];
    spacing_[axis] = factor[axis] * scan.spacing()[axis];
    offset_[axis] = 0.5 * (factor[axis] - 1) * scan.spacing()[axis];
  }
  const std::size_t n =
      static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z());
  std::vector<float> squared(n);
  const double cells = factor.prod();
  std::size_t at = 0;
  for (int k = 0; k < size_.z(); ++k)
    for (int j = 0; j < size_.y(); ++j)
      for (int i = 0; i < size_.x(); ++i)
      {
        double sum = 0.0;
        for (int c = 0; c < factor.z(); ++c)
          for (int b = 0; b < factor.y(); ++b)
            for (int a = 0; a < factor.x(); ++a)
              sum += scan.value(factor.x() * i + a, factor.y() * j + b, factor.z() * k + c);
        squared[at++] = sum / cells > threshold ? kFar : 0.0F;
      }
  squaredDistances(squared, size_, spacing_);
  bool any = false;
  for (float& d : squared)
  {
    const bool core = d < kFar && d > radius * radius;
    any = any || core;
    d = core ? 0.0F : kFar;
  }
  if (!any)
  {
    size_.setZero();
    return;
  }
  squaredDistances(squared, size_, spacing_);
  const double reach = radius + 0.5 * spacing_.maxCoeff();
  wide_.resize(n);
  for (std::size_t p = 0; p < n; ++p)
    wide_[p] = squared[p] < reach * reach;
}

bool WideRegions::contains(const Eigen::Vector3d& p) const
{
  if (size_.x() == 0)
    return false;
  Eigen::Vector3i c;
  for (int axis = 0; axis < 3; ++axis)
    c[axis] = std::clamp(static_cast<int>(std::lround((p[axis] - offset_[axis]) / spacing_[axis])), 0, size_[axis] - 1);
  return wide_[(static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size_.y()) +
                static_cast<std::size_t>(c.y())) *
                   static_cast<std::size_t>(size_.x()) +
               static_cast<std::size_t>(c.x())];
}

}  // namespace endovascular_sim::segmentation
