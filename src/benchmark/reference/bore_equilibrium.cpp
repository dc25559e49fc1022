#include "benchmark/reference/bore_equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Geometry>

#include "rod/linear/banded_ldlt.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kWallStiffness = 1e10;  // N/m² of the bore per length: 0.3 µm at 3000 N/m
constexpr double kRest = 1e-7;           // of the clearance, largest motion in an iteration at rest
constexpr double kLargestMotion = 0.2;   // of the clearance, in an iteration
constexpr double kFollow = 0.01;         // relaxation factor of the compression per iteration
constexpr int kRamp = 20000;             // iterations in which the load grows
constexpr int kMaxIterations = 400000;
constexpr double kMostForce = 1e3;        // N, while the flow moves
constexpr double kIrregularity = 0.01;    // of the clearance: helix at the beginning, from which the wire buckles
constexpr double kLeastResistance = 1e4;  // N·s/m² of the flow, for the condition of the matrix
constexpr std::size_t kHeld = 2;          // stations that are clamped

/** Wire at stations of one spacing. */
class BoreFlow
{
public:
  BoreFlow(double stiffness, const Bore& bore, const BoreEndLoad& load)
    : stiffness_(stiffness),
      bore_(bore),
      load_(load),
      shift_(bore.stations.size()),
      compression_(bore.stations.size(), 0.0)
  {
    for (const BoreStation& station : bore.stations)
      least_clearance_ = std::min(least_clearance_, station.clearance);
    for (std::size_t i = kHeld; i < shift_.size(); ++i)
    {
      const double angle = std::sqrt(load.along / (2.0 * stiffness)) * static_cast<double>(i) * bore.spacing;
      shift_[i] = kIrregularity * least_clearance_ * Vector2d(std::cos(angle), std::sin(angle));
    }
    std::fill(shift_.begin(), shift_.begin() + kHeld, Vector2d::Zero());
  }

  /** Moves the shifts. @param share of the load @return largest motion over the smallest clearance */
  double move(double share)
  {
    assembleElasticity();
    const Vector2d pair = share / bore_.spacing * load_.couple;
    force_.back() += share * load_.across + pair;
    force_[force_.size() - 2] -= pair;
    assemble();
    if (matrix_.factorise() != 0)
      throw std::runtime_error("bore: the step of the flow is too long");
    matrix_.solve(rhs_);
    double largest = 0.0;
    for (const double motion : rhs_)
      largest = std::max(largest, std::abs(motion) / least_clearance_);
    const double part = std::min(1.0, kLargestMotion / largest);
    for (std::size_t i = kHeld; i < shift_.size(); ++i)
      shift_[i] += part * Vector2d(rhs_[2 * (i - kHeld)], rhs_[2 * (i - kHeld) + 1]);
    return largest;
  }

  /** Lets the compression follow the friction. @param share of the load
   *  @return the force that the present loads need [N] */
  double follow(double share)
  {
    double target = share * load_.along;
    for (std::size_t i = shift_.size(); i-- > 0;)
    {
      const double depth = std::max(0.0, shift_[i].norm() - bore_.stations[i].clearance);
      target += bore_.stations[i].friction * kWallStiffness * depth * bore_.spacing;
      compression_[i] += kFollow * (std::min(target, kMostForce) - compression_[i]);
    }
    return target;
  }

private:
  /** Stiffness by bending and compression, the same for both components, and the forces of the axis's shape. */
  void assembleElasticity()
  {
    const std::size_t n = shift_.size();
    const double h = bore_.spacing;
    own_.assign(n, 0.0);
    next_.assign(n, 0.0);
    second_.assign(n, 0.0);
    force_.assign(n, Vector2d::Zero());
    const double bending = stiffness_ / (h * h * h);
    for (std::size_t i = 1; i + 1 < n; ++i)
    {
      own_[i - 1] += bending;
      own_[i] += 4.0 * bending;
      own_[i + 1] += bending;
      next_[i - 1] -= 2.0 * bending;
      next_[i] -= 2.0 * bending;
      second_[i - 1] += bending;
      const Vector2d moment = stiffness_ / h * bore_.stations[i].curvature;
      force_[i - 1] -= moment;
      force_[i] += 2.0 * moment;
      force_[i + 1] -= moment;
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      force_[i] -= compression_[i] * h * bore_.stations[i].curvature;
      if (i + 1 == n)
        break;
      const double compression = 0.5 * (compression_[i] + compression_[i + 1]) / h;
      own_[i] -= compression;
      next_[i] += compression;
      own_[i + 1] -= compression;
    }
  }

  void assemble()
  {
    const std::size_t n = shift_.size();
    const double most = *std::max_element(compression_.begin(), compression_.end());
    const double resistance = (1.3 * most * most / (4.0 * stiffness_) + kLeastResistance) * bore_.spacing;
    matrix_.reset(static_cast<int>(2 * (n - kHeld)));
    rhs_.assign(2 * (n - kHeld), 0.0);
    for (std::size_t i = kHeld; i < n; ++i)
    {
      Vector2d force = force_[i] - own_[i] * shift_[i] - next_[i - 1] * shift_[i - 1] - second_[i - 2] * shift_[i - 2];
      if (i + 1 < n)
        force -= next_[i] * shift_[i + 1];
      if (i + 2 < n)
        force -= second_[i] * shift_[i + 2];
      const double distance = shift_[i].norm();
      double across = 0.0;
      double along = 0.0;
      Vector2d normal = Vector2d::Zero();
      const double clearance = bore_.stations[i].clearance;
      if (distance > clearance)
      {
        const double wall = kWallStiffness * bore_.spacing;
        normal = shift_[i] / distance;
        across = wall * (1.0 - clearance / distance);
        along = wall - across;
        force -= wall * (distance - clearance) * normal;
      }
      const int r = static_cast<int>(2 * (i - kHeld));
      const double diagonal = own_[i] + resistance + across;
      matrix_.at(r, r) = diagonal + along * normal.x() * normal.x();
      matrix_.at(r + 1, r) = along * normal.x() * normal.y();
      matrix_.at(r + 1, r + 1) = diagonal + along * normal.y() * normal.y();
      for (int axis = 0; axis < 2; ++axis)
      {
        rhs_[r + axis] = force[axis];
        if (i + 1 < n)
          matrix_.at(r + 2 + axis, r + axis) = next_[i];
        if (i + 2 < n)
          matrix_.at(r + 4 + axis, r + axis) = second_[i];
      }
    }
  }

  const double stiffness_;
  const Bore& bore_;
  const BoreEndLoad load_;
  double least_clearance_ = std::numeric_limits<double>::max();
  std::vector<Vector2d> shift_;      ///< [m]
  std::vector<double> compression_;  ///< [N]
  std::vector<double> own_, next_, second_;
  std::vector<Vector2d> force_;
  rod::BandedLdlt<5, 2> matrix_;
  std::vector<double> rhs_;
};

}  // namespace

Bore boreAlong(const std::vector<Vector3d>& points, double begin, double end, double spacing,
               const BoreStation& station)
{
  const std::size_t last = points.size() - 1;
  std::vector<double> along(points.size(), 0.0);
  std::vector<Vector2d> curvature(points.size(), Vector2d::Zero());
  Bore bore;
  Vector3d before = (points[1] - points[0]).normalized();
  Vector3d director = before.unitOrthogonal();
  for (std::size_t i = 1; i < last; ++i)
  {
    along[i] = along[i - 1] + (points[i] - points[i - 1]).norm();
    const Vector3d after = (points[i + 1] - points[i]).normalized();
    const Vector3d tangent = (before + after).normalized();
    const double cell = 0.5 * ((points[i + 1] - points[i]).norm() + (points[i] - points[i - 1]).norm());
    const Vector3d turn = (after - before) / cell;
    const Vector3d middle = Eigen::Quaterniond::FromTwoVectors(before, tangent) * director;
    curvature[i] = Vector2d(middle.dot(turn), tangent.cross(middle).dot(turn));
    director = Eigen::Quaterniond::FromTwoVectors(before, after) * director;
    before = after;
    if (along[i] <= end)
      bore.end << director.transpose(), after.cross(director).transpose(), after.transpose();
  }
  along[last] = along[last - 1] + (points[last] - points[last - 1]).norm();
  const auto stations = static_cast<std::size_t>(std::lround((end - begin) / spacing));
  bore.spacing = (end - begin) / static_cast<double>(stations);
  bore.stations.assign(stations, station);
  std::size_t i = 0;
  for (std::size_t k = 0; k < stations; ++k)
  {
    const double s = begin + (static_cast<double>(k) + 0.5) * bore.spacing;
    while (i + 2 < points.size() && along[i + 1] < s)
      ++i;
    const double part = std::clamp((s - along[i]) / (along[i + 1] - along[i]), 0.0, 1.0);
    bore.stations[k].curvature = (1.0 - part) * curvature[i] + part * curvature[i + 1];
  }
  return bore;
}

double pushThroughBore(double stiffness, const Bore& bore, const BoreEndLoad& load)
{
  BoreFlow flow(stiffness, bore, load);
  for (int i = 1; i <= kMaxIterations; ++i)
  {
    const double share = std::min(1.0, static_cast<double>(i) / kRamp);
    const double motion = flow.move(share);
    const double force = flow.follow(share);
    if (i > kRamp + static_cast<int>(10.0 / kFollow) && motion < kRest)
      return force;
  }
  throw std::runtime_error("bore: no equilibrium");
}

}  // namespace endovascular_sim::benchmark
