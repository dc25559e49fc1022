#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/boundary/introducer_guide.h"
#include "rod/coaxial/concentric_stack.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/layer_model.h"
#include "rod/kkt/layer_twists.h"

namespace endovascular_sim::rod
{

/** Insertion of a layer in a step. */
struct LayerMotion
{
  double travel = 0.0;  ///< displacement [m]
  double gained = 0.0;  ///< displacement less that at the last step's speed [m]
};

/** Forces on the handles of a stack's layers along the wire: the gradient of the energy by each layer's insertion, and
 *  the drag of wall and fluid. */
class InsertionForces
{
public:
  /** @param stack, model, twists must outlive this */
  InsertionForces(const ConcentricStack& stack, const KktModel& model, const LayerTwists& twists)
    : stack_(stack), model_(model), twists_(twists), guide_(model.boundary)
  {
  }

  /** ∂E/∂ℓ of a layer at fixed nodes and angles, the other insertions fixed, averaged over the nodes that its joints
   *  pass [N]. The energy is elastic, that of the introducer's guide, and of weight. */
  double gradient(int k, const State& state) const;

  /** Force of the wall against the insertion of a layer's tip between the wall and the layers inside [N]. */
  double wedging(int k, const State& state) const;

  /** Friction of the wall on the nodes at which a layer is the outermost one [N]. */
  double wallDrag(int k, const State& state) const;

  /** Inertia, damping and drag of the fluid against the motion of a layer along itself [N].
   *  @param slides null: every mass moves with its node */
  double motionDrag(int k, const LayerMotion& motion, const LayerSlides* slides, const State& state, double dt) const;

  /** Forces on a layer against its insertion [N]: those of NodalForce::layer. */
  static double loads(int k, const std::vector<NodalForce>& forces, const State& state);

  /** Drag of streams on the nodes at which a layer is the outermost one [N].
   *  @param slides null: the surface moves with the nodes */
  double streamDrag(int k, const std::vector<NodalDrag>& drags, const LayerSlides* slides, const State& state,
                    double dt) const;

private:
  class Side;

  /** Point of the wire on an edge. */
  struct Location
  {
    int node = 0;            ///< first node of the edge
    double parameter = 0.0;  ///< position on the edge, 0 to 1
  };

  Location locate(double arc_length) const;
  Eigen::Vector3d momentAt(int node, const State& state) const;
  Eigen::Vector3d restAt(int k, const Eigen::Vector2d& curvature, const Location& at, const State& state) const;
  double restShare(const Location& at, const State& state) const;
  Side othersAt(int k, double arc_length, const Location& at, double acting, const State& state) const;
  double nextEnd(int k, double begin, double end) const;
  double jointForce(int k, double arc_length, const Section& before, const Section* after, const State& state) const;
  double widening(int k, int node, const LayerProfile::Slope& slope) const;
  double gravityAtNode(int k, int node, const State& state) const;

  const ConcentricStack& stack_;
  const KktModel& model_;
  const LayerTwists& twists_;
  IntroducerGuide guide_;
};

/** Tangent of the centreline at a node, by central differences. */
Eigen::Vector3d tangentAt(const State& state, int node);

}  // namespace endovascular_sim::rod
