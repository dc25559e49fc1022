#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contact/contract/contact_set.h"
#include "intervention/deformable_wall.h"
#include "intervention/treatment.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "scene/model/scene.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** What can happen in a treatment. */
enum class TreatmentEvent
{
  kAboveRated,    ///< a balloon's pressure exceeded its rated burst pressure
  kBurst,         ///< a balloon ruptured
  kStentPlaced,   ///< the balloon has left the opened stent, which stays where it is
  kOverExpanded,  ///< a balloon wanted to open its stent beyond the largest diameter
  kStentLost,     ///< a stent came off its balloon unopened, or was opened outside of the vessel
  kAtRisk,        ///< the vessel was stretched so far that it may tear
};

/** "above_rated", "burst", "stent_placed", "over_expanded", "stent_lost", "at_risk". */
const char* nameOf(TreatmentEvent event);

/** Something that happened, when, and to which instrument. */
struct TimedEvent
{
  std::uint64_t step = 0;
  double time = 0.0;   ///< end of the step [s]
  int instrument = 0;  ///< of the scene
  TreatmentEvent event = TreatmentEvent::kBurst;
};

/** The balloons of a scene at work: between the rod, which carries them, and the wall, which they press.
 *
 *  After every kBalloonLoadPeriod-th step the balloon with the highest pressure presses the wall; contact searches the wall
 *  that comes of it from the next such step on, so that whoever moves the wall has that long to do so. */
class BalloonTreatments
{
public:
  /** @param wall null: no wall moves; must outlive this */
  BalloonTreatments(const scene::Scene& scene, intervention::DeformableWall* wall);

  bool empty() const { return treatments_.empty(); }

  /** Lets contact search the wall that the coming step @p step is with. @return its version; 0 without a moving wall */
  std::uint64_t beginStep(std::uint64_t step);

  /** Least radius of the rod's surface at every node: of balloons and stents where they stand out of the shaft. An
   *  inflated balloon gives way to the wall: it is no wider than where it presses with a small force, and widens
   *  gradually, so that a new node finds out where the wall is [m].
   *  @param contacts last found for the state */
  const std::vector<double>& contactRadii(const rod::State& state, const rod::Discretisation& rod,
                                          const contact::ContactSet& contacts);

  /** Lets pressures act after a step.
   *  @param step just done, from 0
   *  @param commanded at the inflator of every instrument [Pa] */
  void endStep(std::uint64_t step, const std::vector<double>& commanded, const rod::State& state,
               const rod::Discretisation& rod);

  const std::vector<TimedEvent>& events() const { return events_; }  ///< of all steps

  /** Of an instrument with a balloon; else null. */
  const intervention::Treatment* of(int instrument) const;

  /** Saves or loads all that changes, with the wall. */
  void archive(Archive& archive);

private:
  struct Worked
  {
    int instrument;
    intervention::Treatment treatment;
    /** Radius with which it touched the wall last, at distances from the tip, ascending [m]. */
    std::vector<double> places, widths;
    int last_node = 0;  ///< at the first of them

    void archive(Archive& archive);
  };

  double tipOf(int instrument, const rod::State& state, const rod::Discretisation& rod) const;
  double coveredFrom(int instrument, const rod::State& state, const rod::Discretisation& rod) const;
  std::optional<intervention::ShaftLine> shaftOf(const Worked& worked, const rod::State& state,
                                                 const rod::Discretisation& rod) const;
  bool isHeldBack(const Worked& worked, double covered_from, const rod::State& state) const;
  void collectEvents(const Worked& worked, std::uint64_t step);
  void addEvent(std::uint64_t step, int instrument, TreatmentEvent event);
  static double lastWidth(const Worked& worked, double from_tip);
  void widen(Worked& worked, const rod::State& state, const rod::Discretisation& rod, double growth);
  void giveWay(const rod::State& state, const rod::Discretisation& rod, const contact::ContactSet& contacts);
  void pressWall(std::uint64_t step);

  double time_step_;
  double contact_stiffness_;    ///< [N/m]
  std::vector<double> lumens_;  ///< inner radius of every instrument [m]
  std::vector<Worked> treatments_;
  intervention::DeformableWall* wall_;
  std::vector<TimedEvent> events_;
  intervention::BalloonLoad next_;    ///< that the wall is told of with the next pressing
  std::uint64_t shown_ = 0;           ///< version that contact searches
  std::uint64_t due_ = 0;             ///< version that it searches from the next step on that begins such a round
  std::uint64_t promised_ = 0;        ///< version that comes of the last pressing
  int still_ = 0;                     ///< pressings without pressure since the last one with
  bool pressed_ = false;              ///< ever
  bool at_risk_ = false;              ///< told already
  std::vector<double> radii_, hard_;  ///< of every node: that is wanted, and what of it cannot be pressed in [m]
  std::vector<double> places_;
};

}  // namespace endovascular_sim::simulation
