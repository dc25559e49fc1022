#pragma once

#include <string>
#include <vector>

#include "test/common/temporary_folder.h"
#include "vessel/anatomy/anatomy.h"
#include "vessel/centreline/centreline_file.h"

namespace endovascular_sim::segmentation
{

/** Chains of a tree that was written to a file and read as an anatomy. */
inline std::vector<vessel::AnatomyChain> writtenChains(const vessel::CentrelineTree& tree)
{
  const TemporaryFolder folder;
  vessel::writeCentreline(tree, "test", folder.file("tree.yaml"));
  return vessel::sampleChains(vessel::readAnatomy(folder.file("tree.yaml")));
}

}  // namespace endovascular_sim::segmentation
