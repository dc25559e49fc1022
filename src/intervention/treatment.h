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

/** What happened in one step of a treatment. */
struct TreatmentEvents
{
  bool above_rated = false;    ///< the pressure exceeded the balloon's rated burst pressure
  bool burst = false;          ///< the balloon ruptured
  bool stent_placed = false;   ///< the balloon left the opened stent
  bool over_expanded = false;  ///< the balloon opened the stent beyond its largest diameter
  bool stent_lost = false;     ///< the stent came off its balloon unopened, or was opened outside of the vessel
};

/** One balloon catheter, with or without a stent, at work in a vessel: the instrument's side. What it does to the wall
 *  is a DeformableWall's matter. */
class Treatment
{
public:
  /** @param instrument a balloon catheter
   *  @throws InputError when the instrument has no balloon */
  explicit Treatment(const instrument::Instrument& instrument);

  /** Advances by @p dt [s].
   *  @param commanded pressure at the inflator [Pa]
   *  @param shaft as it lies now, as far as it is in the vessel; null: the balloon is outside
   *  @param covered_from distance from the tip from which on another instrument covers it [m]
   *  @return what the wall is to be told; valid until the next step */
  const BalloonLoad& step(double dt, double commanded, const ShaftLine* shaft,
                          double covered_from = std::numeric_limits<double>::infinity());

  const TreatmentEvents& events() const { return events_; }  ///< of the last step
  const BalloonInflation& inflation() const { return inflation_; }
  const std::optional<StentPlacement>& stent() const { return stent_; }
  const BalloonLoad& pressing() const { return pressing_; }  ///< of the last step

  /** The stent is held back: it comes off its balloon where it is. Tells its event with the next step's. */
  void stripStent();

  /** Outer radius at a distance from the tip, of the balloon and a stent that is still on it; 0 where there is neither
   *  [m]. The shaft's own counts where it is larger. */
  double radiusAt(double from_tip) const;

  /** The same of the folded balloon and the crimped stent: what cannot give way [m]. */
  double crossingRadiusAt(double from_tip) const;

  double begin() const { return inflation_.begin(); }  ///< distance from the tip from which on it is there [m]
  double end() const { return inflation_.end(); }      ///< and up to which [m]
  bool carriesStent() const;                           ///< on the balloon, crimped or opened

  /** Saves or loads all that changes. */
  void archive(Archive& archive);

private:
  void followStent(const ShaftLine* shaft);
  bool isUnderStent(double from_tip) const;
  void layBody(const ShaftLine& shaft, double covered_from);

  BalloonInflation inflation_;
  std::optional<StentPlacement> stent_;
  bool stripped_ = false;  ///< since the last step
  TreatmentEvents events_;
  BalloonLoad pressing_;
};

}  // namespace endovascular_sim::intervention
