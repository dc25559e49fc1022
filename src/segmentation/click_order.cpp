#include "segmentation/click_order.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "segmentation/branch_path.h"
#include "segmentation/lumen/minimal_path.h"

namespace endovascular_sim::segmentation
{
namespace
{

ClickPath checkedPath(const Scan& scan, const CheckedBranch& branch, bool is_alone, const std::string& file)
{
  ClickPath path = branchPath(scan, branch, file);
  requireCourse(path, branch, is_alone, file);
  requireDirect(scan, path, branch, file);
  return path;
}

/** Lengths of the paths from one click to all [m]. */
std::vector<double> lengthsFrom(const Scan& scan, const CheckedBranch& branch, std::size_t from,
                                const std::string& file)
{
  std::vector<double> lengths(branch.clicks.size(), 0.0);
  CheckedBranch pair = branch;
  for (std::size_t k = 0; k < lengths.size(); ++k)
  {
    if (k == from)
      continue;
    pair.clicks = {branch.clicks[from], branch.clicks[k]};
    lengths[k] = lengthOf(branchPath(scan, pair, file).points);
  }
  return lengths;
}

/** Order of the clicks along a branch: by the length of the path from the click that is farthest from the first one. It
 * begins with the end that was clicked first. */
std::vector<std::size_t> orderAlong(const Scan& scan, const CheckedBranch& branch, const std::string& file)
{
  const std::vector<double> from_first = lengthsFrom(scan, branch, 0, file);
  const auto end =
      static_cast<std::size_t>(std::max_element(from_first.begin(), from_first.end()) - from_first.begin());
  const std::vector<double> lengths = lengthsFrom(scan, branch, end, file);
  std::vector<std::size_t> order(lengths.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&lengths](std::size_t a, std::size_t b) { return lengths[a] < lengths[b]; });
  if (order.front() > order.back())
    std::reverse(order.begin(), order.end());
  return order;
}

std::string numbersOf(const std::vector<std::size_t>& order)
{
  std::string text;
  for (const std::size_t k : order)
    text += (text.empty() ? "" : ", ") + std::to_string(k + 1);
  return text;
}

}  // namespace

ClickPath orderedPath(const Scan& scan, CheckedBranch& branch, bool is_alone, const std::string& file,
                      std::vector<std::string>& warnings)
{
  try
  {
    return checkedPath(scan, branch, is_alone, file);
  }
  catch (const FoldedPath& fold)
  {
    if (branch.clicks.size() < 3)
      throw;
    try
    {
      const std::vector<std::size_t> order = orderAlong(scan, branch, file);
      CheckedBranch ordered = branch;
      for (std::size_t k = 0; k < order.size(); ++k)
        ordered.clicks[k] = branch.clicks[order[k]];
      ClickPath path = checkedPath(scan, ordered, is_alone, file);
      branch = ordered;
      warnings.push_back(branch.name + ": its clicks were put into their order along the branch: " + numbersOf(order));
      return path;
    }
    catch (const InputError&)  // no order helps: the clicks lie on several branches
    {
      throw fold;
    }
  }
}

}  // namespace endovascular_sim::segmentation
