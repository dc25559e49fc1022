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

/** Events of a treatment. */
enum class TreatmentEvent
{
  kAboveRated,    ///< a balloon's pressure exceeded its rated burst pressure
  kBurst,         ///< a balloon ruptured
  kStentPlaced,   ///< the balloon has left the opened stent, which stays in place
  kOverExpanded,  ///< a balloon reached the largest diameter of its stent
  kStentLost,     ///< a stent came off its balloon unopened, or was opened outside the vessel
  kAtRisk,        ///< the vessel's stretch reached the limit beyond which it may tear
};

/** Name of an event: "above_rated", "burst", "stent_placed", "over_expanded", "stent_lost", "at_risk". */
const char* nameOf(TreatmentEvent event);

/** Event with its time and its instrument. */
struct TimedEvent
{
  std::uint64_t step = 0;
  double time = 0.0;   ///< end of the step [s]
  int instrument = 0;  ///< index in the scene
  TreatmentEvent event = TreatmentEvent::kBurst;
};

/** Balloons and stents of a scene: the coupling of the rod, which carries them, with the wall, which they deform.
 *
 *  Balloons, stents and the deformed wall lie in the vessel at rest, also in a patient who moves.
 *
 *  After every kBalloonLoadPeriod-th step the balloon with the highest pressure loads the wall. Contact detection uses
 * the resulting wall from the next such step on: a lag that leaves time to compute the wall displacement elsewhere. */
class BalloonTreatments
{
public:
  /** @param wall null: a rigid wall; must outlive this */
  BalloonTreatments(const scene::Scene& scene, intervention::DeformableWall* wall);

  bool empty() const { return treatments_.empty(); }

  /** Publishes the wall of the coming step @p step to contact detection.
   *  @return its version; 0 for a rigid wall */
  std::uint64_t beginStep(std::uint64_t step);

  /** Least radius of the rod's surface at every node, where balloons and stents are wider than the shaft [m]. An
   * inflated balloon complies with the wall: its radius is limited to that at which it presses with a small force. It
   * grows by at most 10 µm per call, so that the wall at a new node is detected in time.
   *  @param contacts last detected for the state */
  const std::vector<double>& contactRadii(const rod::State& state, const rod::Discretisation& rod,
                                          const contact::ContactSet& contacts);

  /** Advances inflation and stents after a step, and loads the wall.
   *  @param step number of that step, from 0
   *  @param commanded pressure at the inflator of every instrument [Pa]
   *  @param at_rest places of the nodes in the vessel at rest [m] */
  void endStep(std::uint64_t step, const std::vector<double>& commanded, const rod::State& state,
               const std::vector<Eigen::Vector3d>& at_rest, const rod::Discretisation& rod);

  const std::vector<TimedEvent>& events() const { return events_; }  ///< events of all steps

  /** Treatment of an instrument; null for one without a balloon. */
  const intervention::Treatment* of(int instrument) const;

  /** Largest radius of an instrument's balloon at the last contact query, limited by the wall [m]; 0 without one. */
  double presentRadius(int instrument) const;

  /** Saves or loads all data that change, with those of the wall. */
  void archive(Archive& archive);

private:
  /** Balloon of one instrument. */
  struct InstrumentTreatment
  {
    int instrument;  ///< index in the scene
    intervention::Treatment treatment;
    std::vector<double> positions;  ///< distances from the tip at the last contact query, ascending [m]
    std::vector<double> widths;     ///< radii at those positions [m]
    int last_node = 0;              ///< node of the first position

    void archive(Archive& archive);
  };

  double tipOf(int instrument, const rod::State& state, const rod::Discretisation& rod) const;
  double coveredFrom(int instrument, const rod::State& state, const rod::Discretisation& rod) const;
  std::optional<intervention::ShaftLine> shaftOf(const InstrumentTreatment& treated, const rod::State& state,
                                                 const std::vector<Eigen::Vector3d>& at_rest,
                                                 const rod::Discretisation& rod) const;
  bool isHeldBack(const InstrumentTreatment& treated, double covered_from, const rod::State& state) const;
  void collectEvents(const InstrumentTreatment& treated, std::uint64_t step);
  void addEvent(std::uint64_t step, int instrument, TreatmentEvent event);
  static double lastWidth(const InstrumentTreatment& treated, double from_tip);
  void widen(InstrumentTreatment& treated, const rod::State& state, const rod::Discretisation& rod, double growth);
  void complyWithWall(const rod::State& state, const rod::Discretisation& rod, const contact::ContactSet& contacts);
  void loadWall(std::uint64_t step);

  double time_step_;
  double contact_stiffness_;    ///< [N/m]
  std::vector<double> lumens_;  ///< inner radius of every instrument [m]
  std::vector<InstrumentTreatment> treatments_;
  intervention::DeformableWall* wall_;
  std::vector<TimedEvent> events_;
  intervention::BalloonLoad next_;    ///< load of the next round
  std::uint64_t shown_ = 0;           ///< version of the wall in contact detection
  std::uint64_t due_ = 0;             ///< version of the wall from the next round on
  std::uint64_t promised_ = 0;        ///< version of the wall after the last load
  int still_ = 0;                     ///< rounds without pressure since the last one with pressure
  bool pressed_ = false;              ///< true after the first load
  bool at_risk_ = false;              ///< true after the event
  std::vector<double> radii_, hard_;  ///< radius of every node, and its incompressible part [m]
  std::vector<double> positions_;
};

}  // namespace endovascular_sim::simulation
