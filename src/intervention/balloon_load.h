#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Body of circular cross-section along a curved axis (generalised cylinder). */
struct RoundBody
{
  std::vector<Eigen::Vector3d> axis;  ///< two points or more [m]
  std::vector<double> radii;          ///< one per point of the axis; 0 outside of the body [m]
};

/** Balloon load: action of one instrument on the wall in one step. */
struct BalloonLoad
{
  RoundBody balloon;                ///< balloon with the stent that it carries; empty outside of the vessel
  double pressure = 0.0;            ///< transmural pressure [Pa]; no load unless positive
  std::optional<RoundBody> sleeve;  ///< stent that was placed in this step
};

/** Saves or loads a body or a load. */
void archive(Archive& archive, RoundBody& body);
void archive(Archive& archive, BalloonLoad& load);

}  // namespace endovascular_sim::intervention
