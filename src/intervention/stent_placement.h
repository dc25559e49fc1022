#pragma once

#include <vector>

#include <Eigen/Core>

#include "instrument/balloon.h"
#include "instrument/stent.h"
#include "intervention/shaft_line.h"
#include "intervention/vessel_opening.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Struts of a stent for pictures: rings of a zigzag, one ring per line [m]. Drawn, not the maker's pattern.
 *  @param crowns of each ring
 *  @param ring_length along the stent [m] */
std::vector<std::vector<Eigen::Vector3d>> strutsOf(const RoundBody& sleeve, int crowns = 8,
                                                   double ring_length = 1.5e-3);

/** A stent from its balloon to its place in the vessel. */
class StentPlacement
{
public:
  enum class State
  {
    kCrimped,    ///< on the balloon, moves with it
    kExpanding,  ///< opened by the balloon, still on it
    kPlaced,     ///< stays where it is, in space
    kLost,       ///< came off the balloon before it was opened: lies in the vessel, crimped
  };

  /** @param balloon it is crimped on, in the middle
   *  @param opening_pressure below which it does not open; 3 atm: assumed [Pa] */
  StentPlacement(instrument::Stent stent, const instrument::Balloon& balloon, double opening_pressure = 3.04e5);

  /** Follows the balloon. From its opening pressure on the stent has at least the balloon's diameter, up to its
   * largest; it is placed when the balloon has become narrower than the recoiled stent.
   *  @param balloon_diameter [m]
   *  @return the state afterwards */
  State follow(const ShaftLine& shaft, double pressure, double balloon_diameter);

  /** It is pulled off its balloon: lost, unless it was opened before. */
  void stripOff();

  /** An opened one comes off its balloon: placed where it is. */
  void release();

  State state() const { return state_; }
  double innerDiameter() const { return inner_diameter_; }                                 ///< now [m]
  double outerDiameter() const { return inner_diameter_ + 2.0 * stent_.strut_thickness; }  ///< now [m]
  double strutThickness() const { return stent_.strut_thickness; }                         ///< [m]
  double crimpedDiameter() const { return stent_.crimped_diameter; }                       ///< outer [m]
  double length() const { return stent_.lengthAt(inner_diameter_); }  ///< now: it shortens as it opens [m]
  bool overExpanded() const { return over_expanded_; }  ///< the balloon wanted more than its largest diameter

  /** Its axis and outer radius where it is now. Empty before the first follow(). */
  const RoundBody& sleeve() const { return sleeve_; }

  /** Its struts for pictures, see strutsOf(). */
  std::vector<std::vector<Eigen::Vector3d>> struts(int crowns = 8, double ring_length = 1.5e-3) const
  {
    return strutsOf(sleeve_, crowns, ring_length);
  }

  void archive(Archive& archive);  ///< saves or loads all that changes

private:
  void layAlong(const ShaftLine& shaft);

  instrument::Stent stent_;
  double middle_from_tip_;  ///< of the stent on its balloon [m]
  double opening_pressure_;
  State state_ = State::kCrimped;
  double inner_diameter_;
  bool over_expanded_ = false;
  RoundBody sleeve_;
};

}  // namespace endovascular_sim::intervention
