#pragma once

#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::flow
{

/** Centreline of the natural anatomy without its stenoses. */
inline vessel::CentrelineTree naturalCentreline()
{
  vessel::Anatomy anatomy = vessel::readAnatomy(PROJECT_DIR "/config/anatomies/natural.yaml");
  for (vessel::AnatomyBranch& branch : anatomy.branches)
    branch.stenoses.clear();
  return vessel::anatomyCentreline(anatomy, vessel::sampleChains(anatomy));
}

}  // namespace endovascular_sim::flow
