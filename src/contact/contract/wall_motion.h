#pragma once

#include <vector>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

/** Motion, in a part of a step, of material that moves with the wall, at the nodes of a rod. */
struct WallTravel
{
  std::vector<Eigen::Vector3d> displacement;  ///< [m]
  std::vector<Eigen::Vector3d> turn;          ///< rotation vector [rad]
};

/** Motion of a wall by a smooth map of space during a step. Shares of the step run from 0 to 1. */
class WallMotion
{
public:
  virtual ~WallMotion() = default;

  /** Moves the wall from one share of the step to another: contact sets from now on are those of the wall there.
   *  @param points nodes of the whole wire at the share @p from [m]
   *  @param first first node that is moved; the travel of nodes before it is zero
   *  @param travel of the material at every node */
  virtual void move(double from, double to, const std::vector<Eigen::Vector3d>& points, int first,
                    WallTravel& travel) = 0;

  /** Moves features of the wall by the last move(), with the points and normals; gaps are left to the caller.
   *  @param features of the wall before, at edges of the points of that move */
  virtual void carry(std::vector<Feature>& features) const = 0;
};

}  // namespace endovascular_sim::contact
