#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flow/body/body_flow.h"
#include "flow/coupling/contrast_flow.h"
#include "flow/coupling/flow_source.h"
#include "flow/measurement/pressure_line.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::flow
{

/** Opening of an instrument at which pressure is measured, and the line to its transducer. */
struct LineSettings
{
  double from_tip = 0.0;   ///< distance of the opening from the instrument's tip [m]
  double frequency = 0.0;  ///< natural frequency [Hz]
  double damping = 0.0;    ///< damping ratio [1]
};

/** Steps of the flow in a vessel: heart, vessel and outlets, pressure lines, mean values of beats. Each step is a
 *  function of its request, whatever was computed before. */
class FlowEngine
{
public:
  /** Finds the resistances of the outlets in the healthy vessel, which takes about 0.2 s.
   *  @param lesions of the vessel; @p centreline has their radii
   *  @param time_step [s]
   *  @param volumes of the lumen in each of contrastCells() [m³]; empty: no contrast medium can be injected
   *  @throws InputError for a centreline without branches
   *  @throws std::invalid_argument for another number of volumes than of cells, or one that is negative */
  FlowEngine(const vessel::CentrelineTree& centreline, const std::vector<vessel::PlacedLesion>& lesions,
             const Circulation& circulation, double time_step, std::vector<LineSettings> lines,
             std::vector<double> volumes = {});

  /** @throws ArchiveError for a state of another vessel
   *  @throws std::invalid_argument for a request with too few places, or an injection that is not possible */
  void step(const FlowRequest& request, FlowAnswer& answer);

  const BodyFlow& body() const { return body_; }
  std::size_t lines() const { return lines_.size(); }
  /** Contrast medium; null without volumes. */
  const ContrastFlow* contrast() const { return contrast_ ? &*contrast_ : nullptr; }

private:
  /** Sums over a beat. */
  struct Sums
  {
    double root = 0.0;
    std::vector<double> readings, lesions;
    std::uint32_t beat = 0;  ///< number of beats before this one
    std::uint32_t samples = 0;
    bool hyperaemia = true;

    void archive(Archive& archive);
  };

  void begin(const FlowRequest& request);
  void setControls(const FlowControls& controls);
  double pressureAtPlace(const TreePlace& place) const;
  void addToBeat(const FlowRequest& request);
  void endBeat(std::uint64_t step);
  void clearSums();
  void archive(Archive& archive);
  void archiveContrast(Archive& archive);
  void fill(const FlowRequest& request, FlowField& field) const;

  std::vector<TreePlace> behind_lesions_;
  BodyFlow body_;
  BodyFlow at_rest_;  ///< in the healthy vessel, at the beginning of a beat
  std::optional<ContrastFlow> contrast_;
  std::vector<LineSettings> line_settings_;
  std::vector<PressureLine> lines_;
  Sums sums_;
  BeatMeans means_;
};

/** Engine in this process. */
class LocalFlowSource : public FlowSource
{
public:
  explicit LocalFlowSource(FlowEngine engine) : engine_(std::move(engine)) {}

  void request(const FlowRequest& request) override { engine_.step(request, answer_); }
  FlowAnswer answer() override { return answer_; }

private:
  FlowEngine engine_;
  FlowAnswer answer_;
};

/** For each branch: true where it has a lesion, and short cells. */
std::vector<bool> branchesWithLesions(std::size_t branches, const std::vector<vessel::PlacedLesion>& lesions);

}  // namespace endovascular_sim::flow
