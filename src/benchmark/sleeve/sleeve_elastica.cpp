#include "benchmark/sleeve/sleeve_elastica.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

namespace endovascular_sim::benchmark
{
namespace
{

using State = Eigen::Matrix<double, 5, 1>;  // angle, curvature, x, y, energy

constexpr int kSteps = 400;            // of the Runge–Kutta method over the length
constexpr double kLongestMove = 0.01;  // of the length in one continuation
constexpr double kTolerance = 1e-10;
constexpr int kMaxIterations = 40;
constexpr double kFirstMode = 4.493409457909064;  // clamped and pinned: tan k = k

State slope(const State& at, const Eigen::Vector3d& unknown)
{
  const double cosine = std::cos(at[0]);
  const double sine = std::sin(at[0]);
  State by_length;
  by_length << at[1], unknown[1] * sine - unknown[2] * cosine, cosine, sine, 0.5 * at[1] * at[1];
  return by_length;
}

/** Integrates from the sleeve to the pin. */
State shoot(const Eigen::Vector3d& unknown, double length)
{
  const double h = length / kSteps;
  State at = State::Zero();
  at[1] = unknown[0];
  for (int k = 0; k < kSteps; ++k)
  {
    const State a = slope(at, unknown);
    const State b = slope(at + 0.5 * h * a, unknown);
    const State c = slope(at + 0.5 * h * b, unknown);
    const State d = slope(at + h * c, unknown);
    at += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return at;
}

/** Position of the pinned end and the moment there. */
Eigen::Vector3d residual(const Eigen::Vector3d& unknown, double length)
{
  const State end = shoot(unknown, length);
  return {end[2] - 1.0, end[3], end[1]};
}

}  // namespace

SleeveElastica::SleeveElastica()
{
  // Near the critical load, a deflection a (1 − cos kx) + a (sin kx − kx)/tan k … of small amplitude.
  const double load = kFirstMode * kFirstMode;
  for (const double curvature : {0.5, 0.8, 1.2, 1.6, 2.0})
    for (const double side : {1.0, -1.0})
      if (solve(kShortest, {curvature, -load, side * 0.2 * curvature * kFirstMode}) && std::abs(unknown_[0]) > 0.2)
      {
        length_ = kShortest;
        direction_.setZero();
        return;
      }
  throw std::runtime_error("SleeveElastica: found no buckled rod");
}

/** Newton's method with bounded steps. */
bool SleeveElastica::solve(double length, const Eigen::Vector3d& guess)
{
  Eigen::Vector3d trial = guess;
  for (int k = 0; k < kMaxIterations; ++k)
  {
    const Eigen::Vector3d miss = residual(trial, length);
    if (miss.cwiseAbs().maxCoeff() < kTolerance)
    {
      unknown_ = trial;
      return true;
    }
    Eigen::Matrix3d jacobian;
    for (int j = 0; j < 3; ++j)
    {
      const double step = 1e-6 * std::max(1.0, std::abs(trial[j]));
      Eigen::Vector3d moved = trial;
      moved[j] += step;
      jacobian.col(j) = (residual(moved, length) - miss) / step;
    }
    const Eigen::Vector3d change = -jacobian.partialPivLu().solve(miss);
    trial += std::min(1.0, 0.3 * std::max(1.0, trial.norm()) / change.norm()) * change;
  }
  return false;
}

void SleeveElastica::moveTo(double length)
{
  const int moves = std::max(1, static_cast<int>(std::ceil(std::abs(length - length_) / kLongestMove)));
  const double move = (length - length_) / moves;
  for (int k = 0; k < moves && move != 0.0; ++k)
  {
    const Eigen::Vector3d before = unknown_;
    if (!solve(length_ + move, before + move * direction_) && !solve(length_ + move, before))
      throw std::runtime_error("SleeveElastica: the branch ends");
    direction_ = (unknown_ - before) / move;
    length_ += move;
  }
}

double SleeveElastica::energy() const
{
  return shoot(unknown_, length_)[4];
}

}  // namespace endovascular_sim::benchmark
