#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vessel/anatomy/anatomy.h"
#include "vessel/centreline/centreline_file.h"

namespace endovascular_sim::segmentation
{

/** Chains of a tree that was written to a file and read as an anatomy. */
inline std::vector<vessel::AnatomyChain> writtenChains(const vessel::CentrelineTree& tree)
{
  const std::string file = ::testing::TempDir() + "written_centreline_" + std::to_string(getpid()) + ".yaml";
  vessel::writeCentreline(tree, "test", file);
  const vessel::Anatomy anatomy = vessel::readAnatomy(file);
  std::remove(file.c_str());
  return vessel::sampleChains(anatomy);
}

}  // namespace endovascular_sim::segmentation
