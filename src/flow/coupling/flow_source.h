#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "flow/body/obstruction.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::flow
{

/** What a teacher changes during a run. */
struct FlowControls
{
  double heart_rate = 0.0;     ///< [Hz]; 0: arrest
  double mean_pressure = 0.0;  ///< that the circulation aims at [Pa]
  bool hyperaemia = false;     ///< small vessels of the heart's muscle dilated, as by adenosine

  bool operator==(const FlowControls& other) const
  {
    return heart_rate == other.heart_rate && mean_pressure == other.mean_pressure && hyperaemia == other.hyperaemia;
  }
  bool operator!=(const FlowControls& other) const { return !(*this == other); }
};

void archive(Archive& archive, FlowControls& controls);

/** Reason for which controls are impossible; empty without one. A heart beats at 20 to 300 per minute, or not at all;
 *  mean pressures lie between 2 and 40 kPa. */
std::string refusalOf(const FlowControls& controls);

/** Place in the tree of a centreline. */
struct TreePlace
{
  int branch = -1;   ///< index of the branch; −1: outside the vessel
  double arc = 0.0;  ///< arc length on it [m]
};

/** Opening of an instrument through which contrast medium leaves. */
struct FlowOpening
{
  TreePlace place;
  double share = 1.0;  ///< of the volume, relative to the sum of all openings
};

/** Contrast medium that enters the vessel during a step. */
struct FlowInjection
{
  double volume = 0.0;                ///< in the step [m³]; 0: none
  double concentration = 0.0;         ///< iodine of the medium [kg/m³]
  double viscosity = 0.0;             ///< of the medium [Pa·s]
  std::vector<FlowOpening> openings;  ///< in the vessel
};

/** Input of one step of the flow. With it, the step is a function of its input alone. */
struct FlowRequest
{
  std::uint64_t step = 0;  ///< number of flow steps before this one
  FlowControls controls;
  std::vector<LumenProfile> lumens;         ///< of the lesions, in the present wall
  std::vector<InstrumentSpan> instruments;  ///< in the vessel
  std::vector<TreePlace> probes;            ///< openings of the pressure lines, then further places
  FlowInjection injection;                  ///< during the step
  std::string state;                        ///< of the circulation before the step; empty: the beginning of a run
};

/** Mean values of the last complete beat; zero before the first one. */
struct BeatMeans
{
  double root = 0.0;             ///< pressure at the inlet of the vessel [Pa]
  std::vector<double> readings;  ///< of the pressure lines [Pa]
  std::vector<double> lesions;   ///< pressure behind each lesion [Pa]
  bool hyperaemia = false;       ///< during the whole beat
  std::uint64_t step = 0;        ///< number of the step of the flow that began the next beat
};

/** Iodine since the beginning of a run; that inside and that which left add up to what was injected [kg]. */
struct IodineTotals
{
  double injected = 0.0;
  double inside = 0.0;
  double left = 0.0;  ///< through the outlets and the inlet

  void archive(Archive& archive);
};

/** Pressure and flow in the vessel after a step. Cells and nodes are those of vesselFlowTree(). */
struct FlowField
{
  double phase = 0.0;             ///< of the beat, from 0 at the opening of the aortic valve to 1 [1]
  std::uint32_t beats = 0;        ///< complete ones
  double ventricle = 0.0;         ///< pressure in the left ventricle [Pa]
  std::vector<double> pressures;  ///< of each node [Pa]
  std::vector<double> flows;      ///< of each cell, positive away from the heart [m³/s]
  std::vector<double> areas;      ///< of the free lumen of each cell [m²]
  std::vector<double> probes;     ///< pressure at each place of the request; outside that of the air, 0 [Pa]
  std::vector<double> readings;   ///< of the pressure lines [Pa]
  BeatMeans means;
  std::vector<double> iodine;  ///< concentration of each contrast cell [kg/m³]; empty while there is none
  IodineTotals totals;
};

/** Result of one step of the flow. */
struct FlowAnswer
{
  std::uint64_t step = 0;  ///< that of the request
  FlowField field;
  std::string state;  ///< of the circulation after the step
};

void archive(Archive& archive, BeatMeans& means);
void archive(Archive& archive, FlowAnswer& answer);

/** Computes steps of the flow: in this process, or in the node `hemodynamics`. */
class FlowSource
{
public:
  virtual ~FlowSource() = default;

  /** Begins a step. One at a time: the answer to the request before has been taken. */
  virtual void request(const FlowRequest& request) = 0;

  /** Takes the answer to the last request; waits for it.
   *  @throws InputError when another process does not answer */
  virtual FlowAnswer answer() = 0;
};

}  // namespace endovascular_sim::flow
