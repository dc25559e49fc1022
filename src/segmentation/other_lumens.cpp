#include "segmentation/other_lumens.h"

#include <algorithm>
#include <memory>

#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{

namespace
{

constexpr double kMargin = 5e-4;  // m

/** Tube with a box around it. */
struct BoxedTube
{
  Tube tube;
  Eigen::AlignedBox3d box;

  explicit BoxedTube(const std::vector<Section>& sections) : tube(sections, 2.0 * kMargin)
  {
    for (const Section& section : sections)
    {
      const double radius = *std::max_element(section.radii.begin(), section.radii.end()) + 2.0 * kMargin;
      box.extend(section.centre + Eigen::Vector3d::Constant(radius));
      box.extend(section.centre - Eigen::Vector3d::Constant(radius));
    }
  }
};

}  // namespace

OtherLumen otherLumens(const std::vector<LumenBranch>& branches, std::size_t own)
{
  auto tubes = std::make_shared<std::vector<BoxedTube>>();
  for (std::size_t b = 0; b < branches.size(); ++b)
    if (b != own)
      tubes->emplace_back(branches[b].sections);
  if (tubes->empty())
    return {};
  return [tubes](const Eigen::Vector3d& p)
  {
    return std::any_of(tubes->begin(), tubes->end(),
                       [&p](const BoxedTube& other)
                       { return other.box.contains(p) && other.tube.at(p).distance < kMargin; });
  };
}

}  // namespace endovascular_sim::segmentation
