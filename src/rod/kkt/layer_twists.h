#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/coaxial/concentric_stack.h"
#include "rod/kkt/layer_model.h"
#include "rod/twist/surface_twist.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Twists of the layers of a stack on their shared centreline, and their common action on it. */
class LayerTwists
{
public:
  explicit LayerTwists(int layers) : twist_(layers), active_(layers, 0), chain_(layers) {}

  /** Computes the quasi-static twist of one layer: its twist angles and the torque at its handle.
   *  @param layer the layer as a rod of its own
   *  @param again the centreline is that of the last call */
  void relax(int k, const Discretisation& layer, const TwistBoundary& boundary, State& state, bool again);

  /** Rotates a straight layer rigidly: its angles change by @p turn, its torques do not, but for those of the handle.
   */
  void rotate(int k, const Discretisation& layer, const TwistBoundary& boundary, double turn, State& state);

  /** Linearises the twist of a layer as its last relax() left it, and adds it to the model of the surface: the edges
   * that it has in common with @p on_surface, as far as they follow each other up to the most distal one. The other
   * edges of the layer are eliminated.
   *  @param on_surface layer of every edge of the surface */
  void linearise(int k, const Discretisation& layer, const TwistBoundary& boundary, State& state,
                 const std::vector<int>& on_surface, SurfaceTwist& surface);

  /** Turns a layer by the turns of the surface, after linearise().
   *  @param share factor on the turns */
  void turn(int k, const Discretisation& layer, const TwistBoundary& boundary, const std::vector<double>& turns,
            double share, State& state);

  /** Combines the twists: the mean of the layers' rest curvatures, weighted with their stiffnesses, and the sum of
   * their torques.
   *  @param rod of all layers together */
  TwistAction combine(const ConcentricStack& stack, const Discretisation& rod, const State& state);

  /** True where the twist of a layer acts on the centreline. */
  bool isActive(int k) const { return active_[k] != 0; }

  const QuasiStaticTwist& of(int k) const { return twist_[k]; }

  /** First node with rest curvature of any layer. */
  int firstCurved() const { return first_curved_; }

  /** Combined rest curvature binormal of a node from firstCurved() on [1]. */
  const Eigen::Vector3d& restBinormal(int node) const { return rest_binormal_[node]; }

  /** Combined rest curvature binormals of all nodes from firstCurved() on [1]. */
  const std::vector<Eigen::Vector3d>& restBinormals() const { return rest_binormal_; }

private:
  std::vector<QuasiStaticTwist> twist_;
  std::vector<char> active_;
  std::vector<Eigen::Vector3d> rest_binormal_;
  std::vector<double> torque_;
  int first_curved_ = 0;

  /** Linearised twist of a layer; its edges outside of the surface are eliminated. */
  struct Chain
  {
    int begin = 0;  ///< first edge on the surface
    int end = 0;    ///< after the last one; begin for a layer without edges on the surface
    std::vector<double> gradient, diagonal, upper, turns;
  };
  std::vector<Chain> chain_;
};

}  // namespace endovascular_sim::rod
