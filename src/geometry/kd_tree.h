#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** k-d tree over fixed points for fixed-radius queries. Keeps a reference to the points. */
class KdTree
{
public:
  explicit KdTree(const std::vector<Eigen::Vector3d>& points) : points_(points), order_(points.size())
  {
    std::iota(order_.begin(), order_.end(), 0);
    build(0, order_.size(), 0);
  }

  /** Calls visit(index) for every point within @p radius of @p centre. The order depends on the points only. */
  template <typename Visit>
  void within(const Eigen::Vector3d& centre, double radius, Visit visit) const
  {
    search(0, order_.size(), 0, centre, radius, visit);
  }

private:
  void build(std::size_t begin, std::size_t end, int axis)
  {
    if (end - begin < 2)
      return;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end),
                     [this, axis](int a, int b)
                     {
                       const double x = points_[static_cast<std::size_t>(a)][axis];
                       const double y = points_[static_cast<std::size_t>(b)][axis];
                       return x < y || (x == y && a < b);
                     });
    build(begin, middle, (axis + 1) % 3);
    build(middle + 1, end, (axis + 1) % 3);
  }

  template <typename Visit>
  void search(std::size_t begin, std::size_t end, int axis, const Eigen::Vector3d& centre, double radius,
              Visit& visit) const
  {
    if (begin >= end)
      return;
    const std::size_t middle = begin + (end - begin) / 2;
    const Eigen::Vector3d& point = points_[static_cast<std::size_t>(order_[middle])];
    if ((point - centre).squaredNorm() <= radius * radius)
      visit(order_[middle]);
    const double offset = centre[axis] - point[axis];
    if (offset <= radius)
      search(begin, middle, (axis + 1) % 3, centre, radius, visit);
    if (offset >= -radius)
      search(middle + 1, end, (axis + 1) % 3, centre, radius, visit);
  }

  const std::vector<Eigen::Vector3d>& points_;
  std::vector<int> order_;
};

}  // namespace endovascular_sim::geometry
