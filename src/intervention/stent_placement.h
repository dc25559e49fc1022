#pragma once

#include <vector>

#include <Eigen/Core>

#include "instrument/balloon.h"
#include "instrument/stent.h"
#include "intervention/balloon_load.h"
#include "intervention/shaft_line.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Strut polylines of a stent for rendering: generic zigzag rings, not the pattern of a manufacturer.
 *  @param crowns number of crowns of each ring
 *  @param ring_length axial length of a ring [m]
 *  @return one polyline per ring [m] */
std::vector<std::vector<Eigen::Vector3d>> stentStruts(const RoundBody& sleeve, int crowns = 8,
                                                      double ring_length = 1.5e-3);

/** State of a stent from its delivery balloon to its implantation. */
class StentPlacement
{
public:
  enum class State
  {
    kCrimped,    ///< on the balloon, unexpanded
    kExpanding,  ///< on the balloon, at least partly expanded
    kPlaced,     ///< implanted, fixed in space
    kLost,       ///< dislodged from the balloon before expansion; lies in the vessel, crimped
  };

  /** @param balloon delivery balloon, with the stent crimped on its centre
   *  @param opening_pressure pressure at which expansion begins; 3 atm is assumed [Pa] */
  StentPlacement(instrument::Stent stent, const instrument::Balloon& balloon, double opening_pressure = 3.04e5);

  /** Updates the stent from its balloon. Above the opening pressure the stent takes the balloon's diameter, up to the
   *  largest permitted one. It is placed when the balloon is narrower than the stent after recoil.
   *  @param shaft current centreline of the catheter
   *  @param pressure transmural pressure of the balloon [Pa]
   *  @param balloon_diameter unconstrained diameter of the balloon [m]
   *  @return the updated state */
  State update(const ShaftLine& shaft, double pressure, double balloon_diameter);

  /** Dislodges a crimped stent from its balloon: the stent is lost. No effect in other states. */
  void dislodge();

  /** Releases an expanding stent from its balloon: it is placed at its current pose. No effect in other states. */
  void release();

  State state() const { return state_; }
  double innerDiameter() const { return inner_diameter_; }                                 ///< current [m]
  double outerDiameter() const { return inner_diameter_ + 2.0 * stent_.strut_thickness; }  ///< current [m]
  double strutThickness() const { return stent_.strut_thickness; }                         ///< [m]
  double crimpedDiameter() const { return stent_.crimped_diameter; }                       ///< outer [m]
  double length() const { return stent_.lengthAt(inner_diameter_); }  ///< current length, after foreshortening [m]
  bool overExpanded() const { return over_expanded_; }  ///< true if the balloon has exceeded the largest diameter

  /** Axis and outer radius at the current pose. Empty before the first update(). */
  const RoundBody& sleeve() const { return sleeve_; }

  /** Strut polylines for rendering, see stentStruts(). */
  std::vector<std::vector<Eigen::Vector3d>> struts(int crowns = 8, double ring_length = 1.5e-3) const
  {
    return stentStruts(sleeve_, crowns, ring_length);
  }

  void archive(Archive& archive);  ///< saves or loads the state

private:
  void alignWith(const ShaftLine& shaft);

  instrument::Stent stent_;
  double middle_from_tip_;   ///< distance from the catheter's tip to the stent's centre [m]
  double opening_pressure_;  ///< [Pa]
  State state_ = State::kCrimped;
  double inner_diameter_;  ///< [m]
  bool over_expanded_ = false;
  RoundBody sleeve_;
};

}  // namespace endovascular_sim::intervention
