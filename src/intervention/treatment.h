#pragma once

#include <limits>
#include <optional>

#include "instrument/instrument.h"
#include "intervention/balloon_inflation.h"
#include "intervention/deformable_wall.h"
#include "intervention/shaft_line.h"
#include "intervention/stent_placement.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Events of one step of a treatment. */
struct TreatmentEvents
{
  bool above_rated = false;    ///< the pressure exceeded the balloon's rated burst pressure
  bool burst = false;          ///< the balloon ruptured
  bool stent_placed = false;   ///< the stent was implanted
  bool over_expanded = false;  ///< the balloon exceeded the largest permitted diameter of the stent
  bool stent_lost = false;     ///< the stent was dislodged before expansion, or expanded outside of the vessel
};

/** Treatment state of one balloon catheter with an optional stent. It yields the balloon load; DeformableWall computes
 *  the response of the wall. */
class Treatment
{
public:
  /** @throws InputError if the instrument has no balloon */
  explicit Treatment(const instrument::Instrument& instrument);

  /** Advances balloon and stent by one step.
   *  @param dt time step [s]
   *  @param commanded transmural pressure commanded at the inflator [Pa]
   *  @param shaft current centreline of the shaft inside the vessel; null if the balloon is outside
   *  @param covered_from distance from the tip beyond which another instrument covers the shaft [m]
   *  @return balloon load on the wall; valid until the next step */
  const BalloonLoad& step(double dt, double commanded, const ShaftLine* shaft,
                          double covered_from = std::numeric_limits<double>::infinity());

  const TreatmentEvents& events() const { return events_; }  ///< events of the last step
  const BalloonInflation& inflation() const { return inflation_; }
  const std::optional<StentPlacement>& stent() const { return stent_; }
  const BalloonLoad& load() const { return load_; }  ///< balloon load of the last step

  /** Removes the stent from its balloon at its current pose. The event is reported by the next step. */
  void dislodgeStent();

  /** Outer radius of balloon and carried stent at a distance from the tip [m]; 0 outside of both. The shaft is not
   *  included. */
  double radiusAt(double from_tip) const;

  /** Outer radius of the folded balloon and the crimped stent at a distance from the tip [m]: the rigid profile. */
  double crossingRadiusAt(double from_tip) const;

  double begin() const { return inflation_.begin(); }  ///< distance from the tip to the balloon's distal end [m]
  double end() const { return inflation_.end(); }      ///< distance from the tip to the balloon's proximal end [m]
  bool carriesStent() const;                           ///< true while a crimped or expanding stent is on the balloon

  /** Saves or loads the state. */
  void archive(Archive& archive);

private:
  void updateStent(const ShaftLine* shaft);
  bool isUnderStent(double from_tip) const;
  void updateBalloonBody(const ShaftLine& shaft, double covered_from);

  BalloonInflation inflation_;
  std::optional<StentPlacement> stent_;
  bool dislodged_ = false;  ///< true if the stent has left its balloon since the last step
  TreatmentEvents events_;
  BalloonLoad load_;
};

}  // namespace endovascular_sim::intervention
