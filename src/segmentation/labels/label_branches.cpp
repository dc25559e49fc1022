#include "segmentation/labels/label_branches.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kShortest = 3.0;  ///< length of a stretch with a label of its own, in radii

/** Stretch of a branch with one label. */
struct Stretch
{
  int label = -1;
  std::size_t first = 0;  ///< index of its first point
  std::size_t last = 0;   ///< index of its last point
};

double lengthOf(const vessel::CentrelineBranch& branch, const Stretch& stretch)
{
  double length = 0.0;
  const std::size_t last = std::min(stretch.last + 1, branch.points.size() - 1);  // up to the next stretch
  for (std::size_t k = stretch.first; k < last; ++k)
    length += (branch.points[k + 1] - branch.points[k]).norm();
  return length;
}

/** Length relative to the widest radius. Behind a fork, the centreline leads through the lumen of the parent. */
double relativeLength(const vessel::CentrelineBranch& branch, const Stretch& stretch)
{
  const auto begin = branch.radii.begin();
  return lengthOf(branch, stretch) / *std::max_element(begin + static_cast<std::ptrdiff_t>(stretch.first),
                                                       begin + static_cast<std::ptrdiff_t>(stretch.last) + 1);
}

/** Unites neighbours of one label. */
void unite(std::vector<Stretch>& stretches)
{
  std::vector<Stretch> united;
  for (const Stretch& stretch : stretches)
    if (!united.empty() && united.back().label == stretch.label)
      united.back().last = stretch.last;
    else
      united.push_back(stretch);
  stretches = std::move(united);
}

std::vector<Stretch> stretchesOf(const vessel::CentrelineBranch& branch,
                                 const std::function<int(const Eigen::Vector3d&)>& labelAt)
{
  std::vector<Stretch> stretches;
  for (std::size_t k = 0; k < branch.points.size(); ++k)
    stretches.push_back({labelAt(branch.points[k]), k, k});
  unite(stretches);
  while (stretches.size() > 1)
  {
    // The shortest one, and those without a label before all others.
    std::size_t least = 0;
    double length = 1e30;
    for (std::size_t s = 0; s < stretches.size(); ++s)
      if (const double own = stretches[s].label < 0 ? -1.0 : relativeLength(branch, stretches[s]); own < length)
      {
        length = own;
        least = s;
      }
    if (length >= kShortest)
      break;
    const bool into_next = least == 0 || (least + 1 < stretches.size() && lengthOf(branch, stretches[least + 1]) >
                                                                              lengthOf(branch, stretches[least - 1]));
    stretches[least].label = stretches[into_next ? least + 1 : least - 1].label;
    unite(stretches);
  }
  return stretches;
}

/** Branch of a tree with the index of its label. */
struct Piece
{
  vessel::CentrelineBranch branch;
  int label = 0;
};

/** Pieces of all branches, cut where the label changes, parents before their children. */
std::vector<Piece> piecesOf(const vessel::CentrelineTree& tree,
                            const std::function<int(const Eigen::Vector3d&)>& labelAt)
{
  std::vector<Piece> pieces;
  std::vector<int> last_piece;
  for (const vessel::CentrelineBranch& branch : tree.branches)
  {
    int parent = branch.parent < 0 ? -1 : last_piece[static_cast<std::size_t>(branch.parent)];
    for (const Stretch& stretch : stretchesOf(branch, labelAt))
    {
      Piece piece;
      piece.label = std::max(0, stretch.label);
      piece.branch.parent = parent;
      const std::size_t end = std::min(stretch.last + 2, branch.points.size());
      for (std::size_t k = stretch.first; k < end; ++k)
      {
        piece.branch.points.push_back(branch.points[k]);
        piece.branch.radii.push_back(branch.radii[k]);
      }
      if (piece.branch.points.size() < 2)
        continue;
      parent = static_cast<int>(pieces.size());
      pieces.push_back(std::move(piece));
    }
    last_piece.push_back(parent);
  }
  return pieces;
}

/** Direction over about two radii at the begin or at the end of a branch, in its course. */
Eigen::Vector3d directionAt(const vessel::CentrelineBranch& branch, bool at_end)
{
  const std::size_t n = branch.points.size();
  const auto index = [&](std::size_t k) { return at_end ? n - 1 - k : k; };
  std::size_t k = 1;
  while (k + 1 < n && (branch.points[index(k)] - branch.points[index(0)]).norm() < 2.0 * branch.radii[index(0)])
    ++k;
  const Eigen::Vector3d step = branch.points[index(k)] - branch.points[index(0)];
  return (at_end ? -step : step).normalized();
}

double medianRadius(const vessel::CentrelineBranch& branch)
{
  std::vector<double> radii = branch.radii;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

/** Piece of the same label that continues each piece; −1 without one. */
std::vector<int> continuations(const std::vector<Piece>& pieces)
{
  std::vector<int> continued(pieces.size(), -1);
  std::vector<double> best(pieces.size(), 0.0);
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    if (pieces[p].branch.parent < 0)
      continue;
    const auto parent = static_cast<std::size_t>(pieces[p].branch.parent);
    if (pieces[parent].label != pieces[p].label)
      continue;
    const double merit = medianRadius(pieces[p].branch) *
                         (1.001 + directionAt(pieces[parent].branch, true).dot(directionAt(pieces[p].branch, false)));
    if (merit > best[parent])
    {
      best[parent] = merit;
      continued[parent] = static_cast<int>(p);
    }
  }
  return continued;
}

}  // namespace

vessel::CentrelineTree namedByLabels(const vessel::CentrelineTree& tree,
                                     const std::function<int(const Eigen::Vector3d&)>& labelAt,
                                     const std::vector<std::string>& names)
{
  const std::vector<Piece> pieces = piecesOf(tree, labelAt);
  const std::vector<int> continued = continuations(pieces);
  vessel::CentrelineTree named;
  std::vector<int> branch_of(pieces.size(), -1);
  std::set<std::string> used;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    const vessel::CentrelineBranch& piece = pieces[p].branch;
    const int parent = piece.parent < 0 ? -1 : branch_of[static_cast<std::size_t>(piece.parent)];
    if (piece.parent >= 0 && continued[static_cast<std::size_t>(piece.parent)] == static_cast<int>(p))
    {
      vessel::CentrelineBranch& branch = named.branches[static_cast<std::size_t>(parent)];
      branch.points.insert(branch.points.end(), piece.points.begin() + 1, piece.points.end());
      branch.radii.insert(branch.radii.end(), piece.radii.begin() + 1, piece.radii.end());
      branch_of[p] = parent;
      continue;
    }
    branch_of[p] = static_cast<int>(named.branches.size());
    vessel::CentrelineBranch branch = piece;
    branch.parent = parent;
    const std::string& name = names[static_cast<std::size_t>(pieces[p].label)];
    branch.name = name;
    for (int number = 2; !used.insert(branch.name).second; ++number)
      branch.name = name + "_" + std::to_string(number);
    named.branches.push_back(std::move(branch));
  }
  return named;
}

}  // namespace endovascular_sim::segmentation
