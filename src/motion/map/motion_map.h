#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "motion/map/motion_field.h"

namespace endovascular_sim::motion
{

/** Map of one instant from the resting patient to the moved one: φ(X) = X + w(X) v(X).
 *
 *  The map is C², the identity outside of the fade, and invertible where its field does not fold space (map_bounds.h).
 *  Only + − × ÷ are used, without fused operations: equal inputs give equal bits in every program. A field of zeros
 *  returns its argument bit for bit. */
class MotionMap
{
public:
  /** @param frame axis and fade of the heart
   *  @param field displacement before the fade
   *  @param rate its derivative by the time [1/s] */
  MotionMap(const HeartFrame& frame, const MotionField& field, const MotionField& rate);

  /** Position φ(X) of a point of the resting patient [m]. */
  Eigen::Vector3d position(const Eigen::Vector3d& rest) const;
  /** Displacement u(X) = φ(X) − X [m]. */
  Eigen::Vector3d displacement(const Eigen::Vector3d& rest) const;
  /** Gradient ∇φ(X), with the component i of φ in row i [1]. */
  Eigen::Matrix3d gradient(const Eigen::Vector3d& rest) const;
  /** Velocity ∂u/∂t of the point X of the patient [m/s]. */
  Eigen::Vector3d velocity(const Eigen::Vector3d& rest) const;
  /** Place X = φ⁻¹(x) at rest, by a fixed number of Newton steps. The check of the map bounds the error (map_bounds.h).
   *  @param moved position in the moved patient [m] */
  Eigen::Vector3d pullBack(const Eigen::Vector3d& moved) const;

  /** Positions of many points. @param positions receives as many points as @p rest has */
  void positions(const std::vector<Eigen::Vector3d>& rest, std::vector<Eigen::Vector3d>& moved) const;
  /** Places at rest of many points, with the bits of the single ones. */
  void pullBack(const std::vector<Eigen::Vector3d>& moved, std::vector<Eigen::Vector3d>& rest) const;

  /** The same, with the local deformation |∇φ − 1| at each place, Frobenius norm [1]: no length is compressed by more.
   */
  void pullBack(const std::vector<Eigen::Vector3d>& moved, std::vector<Eigen::Vector3d>& rest,
                std::vector<double>& deformation) const;

  /** Map between two of one frame, linear in the share.
   *  @param share 0: @p from, bit for bit; 1: @p to, bit for bit */
  static MotionMap between(const MotionMap& from, const MotionMap& to, double share);

  /** Motion of material from this map to another one of the same frame.
   *  @param rest places at rest [m]; those before @p first are skipped, and get zeros
   *  @param displacement φ'(X) − φ(X) [m]
   *  @param turn rotation vector of the material, of first order in that motion [rad] */
  void motionTo(const MotionMap& other, const std::vector<Eigen::Vector3d>& rest, std::size_t first,
                std::vector<Eigen::Vector3d>& displacement, std::vector<Eigen::Vector3d>& turn) const;

  /** Closest feature of the resting wall in the moved patient. */
  struct Feature
  {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< φ(P) [m]
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< ∇φ⁻ᵀN, unit
    double distance_scale = 1.0;  ///< 1/|∇φ⁻ᵀN|: distance from the wall, moved per resting [1]
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the wall [m/s]
  };
  /** Pushes a feature forward: P with the wall's normal N becomes φ(P) with that of the moved wall. Distances from the
   *  wall scale by distance_scale to first order; a radius does not scale. @param point P [m]  @param normal N, unit */
  Feature pushForward(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /** Points and unit normals of the resting wall in the moved patient. Those outside of the fade stay.
   *  @param points [m]  @param normals as many */
  void pushForward(std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals) const;
  /** Points and unit normals of the wall in this map, moved to another map of the same frame. Those outside of the fade
   *  stay.
   *  @param guesses places at rest: one Newton step from there is taken [m]
   *  @param points [m]  @param normals as many */
  void carryTo(const MotionMap& other, const std::vector<Eigen::Vector3d>& guesses,
               std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals) const;
  /** Unit normal of the resting wall from that of the moved one: ∇φᵀn, the inverse of pushForward().
   *  @param rest place of the wall at rest [m] */
  Eigen::Vector3d restingNormal(const Eigen::Vector3d& rest, const Eigen::Vector3d& normal) const;

  /** True if the map is the identity. */
  bool resting() const { return resting_; }
  /** True if the point is outside of the fade, so that it never moves. */
  bool outside(const Eigen::Vector3d& point) const;

  const HeartFrame& frame() const { return frame_; }
  const MotionField& field() const { return field_; }
  const MotionField& rate() const { return rate_; }

private:
  HeartFrame frame_;
  MotionField field_, rate_;
  bool resting_;
};

}  // namespace endovascular_sim::motion
