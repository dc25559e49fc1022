#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flow/body/circulation.h"
#include "flow/body/heart.h"
#include "flow/body/obstruction.h"
#include "flow/body/vessel_flow_tree.h"
#include "flow/network/flow_network.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::flow
{

/** Flow of blood in a vessel with heart and peripheral circulation.
 *
 *  The resistances of the outlets are chosen such that, in the vessel that is given, the mean pressure at its inlet and
 *  the mean flow of each outlet are those of the circulation at rest. A vessel that is smaller than an aorta takes its
 *  share of the cardiac output by the cube of its diameter; the rest leaves at its inlet. */
class BodyFlow
{
public:
  /** @param time_step of the flow [s]
   *  @param fine for each branch: true selects short cells
   *  @throws InputError for a centreline that is no tree, or a branch without length or lumen */
  BodyFlow(const vessel::CentrelineTree& centreline, const Circulation& circulation, double time_step,
           const std::vector<bool>& fine);

  /** Remarks for the user, e.g. outlets whose flow follows from their diameters. */
  const std::vector<std::string>& remarks() const { return remarks_; }

  const Circulation& circulation() const { return circulation_; }
  const VesselFlowTree& vessel() const { return vessel_; }
  FlowNetwork& network() { return network_; }
  const FlowNetwork& network() const { return network_; }
  Heart& heart() { return heart_; }
  const Heart& heart() const { return heart_; }

  /** Resistance of the small vessels of the heart's muscle, relative to that at rest: 1, or 1/hyperaemia. */
  void setHyperaemia(bool is_on);
  bool isHyperaemic() const { return is_hyperaemic_; }
  /** Mean pressure that all other resistances aim at, with the cardiac output of rest [Pa]. */
  void setMeanPressure(double pressure);
  double meanPressure() const { return mean_pressure_; }

  /** Sets what narrows the vessel from the next step on.
   *  @param lumens stretches whose lumen is not that of the centreline
   *  @param instruments pieces of instruments and balloons in it */
  void setObstruction(const std::vector<LumenProfile>& lumens, const std::vector<InstrumentSpan>& instruments);

  void step();

  double rootPressure() const { return network_.pressure(0); }  ///< at the inlet [Pa]
  double ventriclePressure() const { return heart_.ventricle(rootPressure()); }
  /** Pressure at a place of the vessel [Pa]. Where an instrument or a lesion narrows a cell, the pressure drops there.
   *  @param arc length on the branch [m] */
  double pressureAt(int branch, double arc) const;
  /** Flow at a place of the vessel [m³/s]. */
  double flowAt(int branch, double arc) const;
  /** Index of the cell that holds a place; that of the nearest end beyond the cells. */
  std::size_t cellAt(int branch, double arc) const;

  /** All that later steps depend on, apart from the inputs of the constructor and the obstruction, which the owner
   *  sets again.
   *  @throws ArchiveError for an archive of another vessel */
  void archive(Archive& archive);

private:
  void calibrate();
  void runBeats(int beats, std::vector<double>& flows, double& pressure);
  void setFactors();

  Circulation circulation_;
  std::vector<std::string> remarks_;
  VesselFlowTree vessel_;
  std::vector<double> targets_;  // mean flow of each outlet of the network at rest [m³/s]
  std::vector<double> muscle_;   // pressure around each outlet's small vessels, relative to the ventricle's
  FlowNetwork network_;
  Obstruction obstruction_;
  Heart heart_;
  double mean_pressure_;
  bool is_hyperaemic_ = false;
  std::vector<double> back_;         // pressure behind each outlet [Pa]
  std::vector<double> calibration_;  // factor of each outlet's resistance at rest
};

}  // namespace endovascular_sim::flow
