#pragma once

#include <cstddef>
#include <limits>
#include <optional>

#include "instrument/instrument.h"
#include "intervention/balloon_inflation.h"
#include "intervention/shaft_line.h"
#include "intervention/stent_placement.h"
#include "intervention/vessel_opening.h"

namespace endovascular_sim::intervention
{

/** What happened in one step of a treatment. */
struct TreatmentEvents
{
  bool above_rated = false;    ///< the pressure exceeded the balloon's rated burst pressure
  bool burst = false;          ///< the balloon ruptured
  bool stent_placed = false;   ///< the balloon left the opened stent
  bool over_expanded = false;  ///< the balloon opened the stent beyond its largest diameter
  bool at_risk = false;        ///< the vessel was stretched so far that it may tear
};

/** One balloon catheter, with or without a stent, at work in a vessel. */
class Treatment
{
public:
  /** @param instrument a balloon catheter
   *  @param opening of the vessel, shared by all instruments in it; must outlive the treatment
   *  @throws InputError when the instrument has no balloon */
  Treatment(const instrument::Instrument& instrument, VesselOpening& opening);

  /** Advances by @p dt [s].
   *  @param commanded pressure at the inflator [Pa]
   *  @param shaft as it lies now; must reach over the balloon with its cones
   *  @param most vertices to move in this step, see VesselOpening::press()
   *  @return the vertices that moved; valid until the next step */
  const MovedVertices& step(double dt, double commanded, const ShaftLine& shaft,
                            std::size_t most = std::numeric_limits<std::size_t>::max());

  const TreatmentEvents& events() const { return events_; }  ///< of the last step
  const BalloonInflation& inflation() const { return inflation_; }
  const std::optional<StentPlacement>& stent() const { return stent_; }
  /** The stent came off its balloon unopened. */
  void stripStent();

  /** Outer radius at a distance from the tip, of the balloon and a stent that is still on it; 0 where there is neither
   *  [m]. The shaft's own counts where it is larger. */
  double radiusAt(double from_tip) const;

private:
  bool carriesStent() const;
  RoundBody body(const ShaftLine& shaft) const;

  BalloonInflation inflation_;
  std::optional<StentPlacement> stent_;
  VesselOpening& opening_;
  TreatmentEvents events_;
};

}  // namespace endovascular_sim::intervention
