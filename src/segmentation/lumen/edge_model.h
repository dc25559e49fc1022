#pragma once

namespace endovascular_sim::segmentation
{

/** Value of a blurred vessel at its edge.
 *
 *  Model: a disc of lumen of radius R, a wall of thickness w, and a surrounding, each of constant value, blurred by a
 *  Gaussian of standard deviation σ. At the edge of a blurred disc of value 1,
 *
 *      D(R) = ½(1 − e^{−ρ²} I₀(ρ²)),  ρ = R/σ,
 *
 *  which is ½ for a plane edge and 0.33 for R = σ. The surrounding behind the wall contributes the share
 *  √((R + w)/R) · Φ(−w/σ), the leading term of Marcum's function Q₁(R/σ, (R + w)/σ). */
class EdgeModel
{
public:
  /** @param spread σ [m]
   *  @param wall w [m]; 0: no wall */
  EdgeModel(double spread, double wall) : spread_(spread), wall_(wall) {}

  /** Value at the edge of a lumen.
   *  @param radius R [m]
   *  @param beyond value of the surrounding behind the wall */
  double edgeValue(double radius, double lumen, double wall, double beyond) const;

  /** D: value at the edge of a blurred disc of value 1. */
  double discAtEdge(double radius) const;

  /** 1 − e^{−ρ²/2}: value in the middle of a blurred disc of value 1. */
  double discInMiddle(double radius) const;

  /** Inverse of discInMiddle(): σ √(−2 ln(1 − part)) [m]. */
  double radiusOfMiddle(double part) const;

  /** Share of the surrounding behind the wall in the value at the edge. */
  double beyondWall(double radius) const;

  /** Share of bone in the value at the edge, Φ(−g/σ), for a plane surface at a distance g behind the edge [m]. */
  double beyondGap(double gap) const;

  double spread() const { return spread_; }
  double wall() const { return wall_; }

private:
  double spread_;
  double wall_;
};

/** e^{−x} I₀(x), the scaled modified Bessel function, for x ≥ 0 (M. Abramowitz, I. Stegun, 9.8.1 and 9.8.2; relative
 * error below 2·10⁻⁷). */
double scaledBesselI0(double x);

}  // namespace endovascular_sim::segmentation
