#pragma once

#include <vector>

#include "procedure/branch_locator.h"
#include "procedure/observation.h"
#include "scene/model/scene.h"

namespace endovascular_sim::procedure
{

/** Watches whether catheters stay where they support an instrument that they guide.
 *
 *  A catheter supports in the branch that has held its tip for ErrorLimits::support_time, while an instrument inside it
 *  is ahead of its tip. The support is lost when for as long neither tip is in this branch or beyond, although the
 *  handle of the catheter has not been withdrawn: the instruments have slipped out of an ostium or fallen back. */
class SupportWatch
{
public:
  /** @param entered branch that contains the introducer */
  SupportWatch(const scene::Scene& scene, const BranchLocator& locator, int entered);

  /** Adds an observation with the branches of the tips, at any rate.
   *  @return catheters that lose their support at this time */
  std::vector<int> add(const Observation& observation);

private:
  /** Catheter of the scene. */
  struct Catheter
  {
    int instrument = 0;
    int occupied = -1;       ///< branch of its tip
    double since = 0.0;      ///< time since which this is its branch [s]
    int support = -1;        ///< branch in which it supports; −1: none
    double inserted = 0.0;   ///< largest insertion while it was there [m]
    double lost_since = -1;  ///< time since which no tip is there; negative: one is [s]
  };

  bool losesSupport(Catheter& catheter, const Observation& observation) const;
  bool isHeld(const Catheter& catheter, const Observation& observation) const;
  bool isBeyond(int support, const InstrumentView& view) const;

  scene::ErrorLimits limits_;
  std::vector<std::vector<bool>> way_;  ///< per branch: the branches on the path to it from the introducer
  std::vector<Catheter> catheters_;
};

}  // namespace endovascular_sim::procedure
