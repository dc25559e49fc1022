#pragma once

#include "rod/twist/twist.h"

namespace endovascular_sim::benchmark
{

constexpr double kDegree = 3.14159265358979323846 / 180.0;

/** A pre-curved wire on a planar bend of the same curvature, √(EI κ κ0/GJ)·L = lambda, held at its first edge. */
class Transmission
{
public:
  Transmission(double lambda, int nodes);

  /** Turns the hand [rad]; returns the tip's angle. */
  double turnTo(double angle);

  /** Hand angle at which the tip first reaches an angle [rad]. */
  double handAngleFor(double tip);

  /** Hand angle at which the tip jumps [rad]. */
  double snap();

private:
  rod::Discretisation rod_;
  rod::State state_;
  rod::TwistBoundary hold_;
  rod::QuasiStaticTwist twist_;
};

}  // namespace endovascular_sim::benchmark
