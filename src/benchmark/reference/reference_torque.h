#pragma once

#include "common/units.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::benchmark
{

using units::kDegree;

/** Torque transmission of a pre-curved wire on a planar bend of the same curvature, √(EI κ κ0/GJ)·L = lambda. */
class Transmission
{
public:
  Transmission(double lambda, int nodes);

  /** Rotates the proximal end.
   *  @param angle proximal angle [rad]
   *  @return angle of the tip [rad] */
  double rotateTo(double angle);

  /** Proximal angle at which the tip first reaches an angle [rad]. */
  double proximalAngleFor(double tip);

  /** Proximal angle of the snap-through of the tip [rad]. */
  double snapThrough();

private:
  rod::Discretisation rod_;
  rod::State state_;
  rod::TwistBoundary hold_;
  rod::QuasiStaticTwist twist_;
};

}  // namespace endovascular_sim::benchmark
