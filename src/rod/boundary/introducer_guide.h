#pragma once

#include <array>

#include <Eigen/Core>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Potential of the introducer on a straight edge, with its derivatives by the positions of both nodes. */
struct GuidedEdge
{
  double energy = 0.0;                      ///< [J]
  std::array<Eigen::Vector3d, 2> gradient;  ///< [N]
  /** Second derivatives: block of the first node, of the second one (row) with the first one, of the second node
   *  [N/m]. */
  Eigen::Matrix3d first, across, second;

  void reset();
};

/** Offset of a curved wire from the chord of an edge at its parameter t: 4t(1 − t) even + t(1 − t)(1 − 2t) odd [m]. */
struct EdgeBow
{
  Eigen::Vector3d even = Eigen::Vector3d::Zero();
  Eigen::Vector3d odd = Eigen::Vector3d::Zero();
};

/** Potential of the introducer on a curved edge, with its derivatives by the positions of both nodes and by the bow. */
struct CurvedEdge : GuidedEdge
{
  EdgeBow by_bow;                           ///< [N]
  Eigen::Matrix3d first_even, second_even;  ///< second derivatives by a node and by EdgeBow::even, symmetric [N/m]
};

/** Second derivatives of the guide's potential. */
enum class GuideStiffness
{
  kExact,         ///< indefinite
  kSemiDefinite,  ///< positive semi-definite: too stiff along the axis, for schemes whose matrix must be definite
  kLateral        ///< neither force nor stiffness along the axis
};

/** Guide of the introducer: a potential in space that holds the wire on the introducer's axis,
 *
 *      U = ∫ ½ EI ((X_e − X)/λ)³/λ⁴ |Y|² ds   over the wire at X < X_e,
 *
 *  with the axial coordinate X (0 at the mouth), the lateral offset Y, and the decay length λ. The wire bends in it
 * like a wire that is clamped at the mouth: X_e = kReach λ compensates for its compliance. The potential depends on the
 *  positions alone. It therefore pushes a bent wire out with the configurational force ½EIκ². Edges are integrated
 *  exactly up to X_e, where the potential and its first two derivatives vanish.
 *
 *  The exact second derivatives are indefinite. The semi-definite form overestimates those along the axis; the force on
 *  the hand then depends on the travel per step. */
class IntroducerGuide
{
public:
  /** Depth of a clamp that a rod under an end moment sees behind the end of a foundation of stiffness EI z³/λ⁷, over λ;
   *  from the boundary value problem y'''' + z³ y = 0. */
  static constexpr double kReach = 1.9313;

  explicit IntroducerGuide(const Boundary& boundary);

  /** True for a node from which on an edge may be guided: it lies before the guide's end. */
  bool holds(const Eigen::Vector3d& position) const { return decay_ != 0.0 && !(axial(position) >= reach_); }

  /** Calls visit(edge, term) for every edge of a wire in the guide. The wire leaves the guide once: what returns to its
   *  space is outside. */
  template <typename Visit>
  void forEachEdge(const Discretisation& rod, const State& state, Visit visit,
                   GuideStiffness form = GuideStiffness::kExact) const
  {
    GuidedEdge term;
    for (int j = state.first_node; j + 1 < rod.nodes() && holds(state.position[j]); ++j)
    {
      const double stiffness = 0.5 * (rod.bending_stiffness[j] + rod.bending_stiffness[j + 1]);
      evaluate(state.position[j], state.position[j + 1], stiffness * rod.rest_length[j], term, form);
      visit(j, term);
    }
  }

  /** Computes the potential of an edge.
   *  @param weight bending stiffness times rest length [N·m³] */
  void evaluate(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double weight, GuidedEdge& edge,
                GuideStiffness form = GuideStiffness::kExact) const;

  /** Computes the potential of a curved edge, by the same points. The gradient is exact. */
  void evaluate(const Eigen::Vector3d& first, const Eigen::Vector3d& second, const EdgeBow& bow, double weight,
                CurvedEdge& edge) const;

  /** Energy per length and bending stiffness at a point of the wire [1/m²]. */
  double density(const Eigen::Vector3d& position) const;

private:
  struct Point;
  Point pointAt(double depth, const Eigen::Vector3d& lateral, double scale, GuideStiffness form) const;
  double axial(const Eigen::Vector3d& position) const { return direction_.dot(position - origin_); }

  Eigen::Vector3d origin_, direction_;
  double decay_;  ///< λ [m]; 0: no guide
  double reach_;  ///< X_e [m]
};

}  // namespace endovascular_sim::rod
