#include "visualization/name_placement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Geometry>

namespace endovascular_sim::visualization
{
namespace
{

constexpr double kSmallestDepth = 5e-3;  // of a point in the picture [m]
constexpr double kSpacing = 4.0;         // of the points of a drawn branch [pixels]
constexpr int kMostParts = 64;           // of a segment of a centreline
constexpr double kMargin = 2.0;          // between names; also, least lead of the own branch over the next one [pixels]
constexpr int kDirections = 16;          // of a leader
constexpr double kShares[] = {0.5, 0.6, 0.4, 0.7, 0.3, 0.8, 0.2, 0.9, 0.1};  // ends of a leader along the branch
constexpr double kLengths[] = {0.2, 0.5, 1.0,
                               1.7, 2.7, 4.0};  // of a leader beyond the wall, relative to the name's height
constexpr double kInset = 0.6;                  // of the end of a leader from the centreline towards the name, in radii
constexpr double kCostOfCovering = 3.0;         // of a name that covers its own branch, in heights of the name
constexpr double kCostOfSlope = 1.0;            // of a vertical leader
constexpr double kCostOfShare = 2.0;            // of a leader at an end of the branch

struct Leader
{
  Eigen::Vector2d begin, end;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

bool doCross(const Leader& a, const Leader& b)
{
  const auto sides = [](const Leader& line, const Leader& of)
  {
    const Eigen::Vector2d along = line.end - line.begin;
    return cross(along, of.begin - line.begin) * cross(along, of.end - line.begin);
  };
  return sides(a, b) < 0.0 && sides(b, a) < 0.0;
}

/** True if a leader meets a rectangle. */
bool doesMeet(const Leader& leader, const Rectangle& box)
{
  double first = 0.0, last = 1.0;
  const Eigen::Vector2d along = leader.end - leader.begin;
  for (Eigen::Index axis = 0; axis < 2; ++axis)
  {
    if (std::abs(along[axis]) < 1e-9)
    {
      if (leader.begin[axis] <= box.low[axis] || leader.begin[axis] >= box.high[axis])
        return false;
      continue;
    }
    const double a = (box.low[axis] - leader.begin[axis]) / along[axis];
    const double b = (box.high[axis] - leader.begin[axis]) / along[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first < last;
}

/** Branch in the picture: points of its centreline that lie in it. */
struct DrawnBranch
{
  const BranchToName* branch = nullptr;
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<Eigen::Vector2d> places;  ///< [pixels]
  std::vector<double> radii;            ///< [pixels]
  std::vector<double> arcs;             ///< lengths in the picture, of the part within the reach [pixels]
  Rectangle box;                        ///< around the drawn wall

  bool isEmpty() const { return places.empty(); }
  double length() const { return arcs.empty() ? 0.0 : arcs.back(); }

  /** Distance of the drawn wall from a rectangle; at least @p enough if it is not below. */
  double distance(const Rectangle& from, double enough) const
  {
    const Eigen::Vector2d gap = (box.low - from.high).cwiseMax(from.low - box.high).cwiseMax(0.0);
    if (isEmpty() || gap.norm() >= enough)
      return enough;
    double least = enough;
    for (std::size_t i = 0; i < places.size(); ++i)
      least = std::min(least, std::max(from.distance(places[i]) - radii[i], 0.0));
    return least;
  }
};

/** Number of parts into which a segment of a centreline is divided in the picture. */
int partsOf(const Eigen::Vector3d& begin, const Eigen::Vector3d& end, const PictureView& view)
{
  if (view.depth(begin) < kSmallestDepth || view.depth(end) < kSmallestDepth)
    return kMostParts;
  const double length = (view.project(end) - view.project(begin)).norm();
  return static_cast<int>(std::clamp(std::ceil(length / kSpacing), 1.0, static_cast<double>(kMostParts)));
}

void append(const Eigen::Vector3d& point, double radius, const PictureView& view, DrawnBranch& drawn)
{
  const double depth = view.depth(point);
  if (depth < kSmallestDepth)
    return;
  const Eigen::Vector2d place = view.project(point);
  if (std::abs(place.x()) > 0.5 * view.width || std::abs(place.y()) > 0.5 * view.height)
    return;
  const double pixels = radius * view.focal / depth;
  const double step = drawn.isEmpty() || depth > view.reach ? 0.0 : (place - drawn.places.back()).norm();
  const Rectangle around = Rectangle::around(place, Eigen::Vector2d::Constant(2.0 * pixels));
  drawn.box =
      drawn.isEmpty() ? around : Rectangle{drawn.box.low.cwiseMin(around.low), drawn.box.high.cwiseMax(around.high)};
  drawn.arcs.push_back(drawn.length() + step);
  drawn.points.push_back(point);
  drawn.places.push_back(place);
  drawn.radii.push_back(pixels);
}

DrawnBranch draw(const BranchToName& branch, const PictureView& view)
{
  DrawnBranch drawn;
  drawn.branch = &branch;
  for (std::size_t i = 0; i + 1 < branch.points.size(); ++i)
  {
    const int parts = partsOf(branch.points[i], branch.points[i + 1], view);
    for (int k = i == 0 ? 0 : 1; k <= parts; ++k)
    {
      const double share = static_cast<double>(k) / parts;
      append((1.0 - share) * branch.points[i] + share * branch.points[i + 1],
             (1.0 - share) * branch.radii[i] + share * branch.radii[i + 1], view, drawn);
    }
  }
  return drawn;
}

/** Place that a name could take. */
struct Candidate
{
  Eigen::Vector3d end;     ///< as PlacedName::end
  Eigen::Vector2d place;   ///< of the end [pixels]
  Eigen::Vector2d offset;  ///< as PlacedName::offset
  double cost = 0.0;
};

/** Appends the places of a name on one side of a point of its branch. */
void appendPlaces(const DrawnBranch& drawn, std::size_t point, double angle, double aside, const PictureView& view,
                  std::vector<Candidate>& candidates)
{
  const Eigen::Vector2d& size = drawn.branch->size;
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  const double radius = drawn.radii[point] * view.depth(drawn.points[point]) / view.focal;
  const Eigen::Vector3d end =
      drawn.points[point] + kInset * radius * (direction.x() * view.right + direction.y() * view.up);
  const Eigen::Vector2d corner(std::clamp(2.0 * direction.x(), -1.0, 1.0), direction.y());
  for (const double length : kLengths)
  {
    const double beyond = (1.0 - kInset) * drawn.radii[point] + length * size.y();
    candidates.push_back({end, view.project(end), beyond * direction + 0.5 * corner.cwiseProduct(size),
                          length + kCostOfSlope * std::abs(direction.y()) + aside});
  }
}

/** Places of a name, the best ones first. */
std::vector<Candidate> candidatesOf(const DrawnBranch& drawn, const PictureView& view)
{
  std::vector<Candidate> candidates;
  for (const double share : kShares)
  {
    const auto at = std::lower_bound(drawn.arcs.begin(), drawn.arcs.end(), share * drawn.length());
    const auto point = static_cast<std::size_t>(at - drawn.arcs.begin());
    const double aside = kCostOfShare * std::abs(share - 0.5);
    candidates.push_back({drawn.points[point], drawn.places[point], Eigen::Vector2d::Zero(), kCostOfCovering + aside});
    for (int k = 0; k < kDirections; ++k)
      appendPlaces(drawn, point, 2.0 * M_PI * k / kDirections, aside, view, candidates);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return candidates;
}

/** Search for places of names, one after the other. */
class PlaceSearch
{
public:
  PlaceSearch(const std::vector<DrawnBranch>& branches, const PictureView& view) : branches_(branches), view_(view) {}

  /** Takes a place if it is free. */
  bool take(const DrawnBranch& own, const Eigen::Vector2d& end, const Eigen::Vector2d& offset)
  {
    const Rectangle box = Rectangle::around(end + offset, own.branch->size);
    const Leader leader{box.nearest(end), end};
    if (!isInThePicture(box) || !isFree(box, leader) || !isOwnNearest(own, box) || !isClear(own, leader))
      return false;
    boxes_.push_back(box);
    leaders_.push_back(leader);
    return true;
  }

private:
  bool isInThePicture(const Rectangle& box) const
  {
    const Eigen::Vector2d half = 0.5 * Eigen::Vector2d(view_.width, view_.height);
    const Eigen::Vector2d legend_end(view_.legend_width - half.x(), view_.legend_height - half.y());
    if (box.low.x() < legend_end.x() && box.low.y() < legend_end.y())
      return false;
    return (box.low.array() > -half.array()).all() && (box.high.array() < half.array()).all();
  }

  bool isFree(const Rectangle& box, const Leader& leader) const
  {
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMargin);
    const Rectangle wide{box.low - margin, box.high + margin};
    for (std::size_t k = 0; k < boxes_.size(); ++k)
      if (wide.overlaps(boxes_[k]) || doesMeet(leader, boxes_[k]) || doesMeet(leaders_[k], wide) ||
          doCross(leader, leaders_[k]))
        return false;
    return true;
  }

  bool isOwnNearest(const DrawnBranch& own, const Rectangle& box) const
  {
    const double needed = own.distance(box, 1e9) + kMargin;
    return std::all_of(branches_.begin(), branches_.end(),
                       [&](const DrawnBranch& other)
                       { return other.branch == own.branch || other.distance(box, needed) >= needed; });
  }

  /** True if no other branch covers or crosses the leader. */
  bool isClear(const DrawnBranch& own, const Leader& leader) const
  {
    const Eigen::Vector2d along = leader.begin - leader.end;
    const int parts = static_cast<int>(std::ceil(along.norm() / kSpacing)) + 1;
    for (int k = 0; k <= parts; ++k)
    {
      const Eigen::Vector2d point = leader.end + static_cast<double>(k) / parts * along;
      const Rectangle around = Rectangle::around(point, Eigen::Vector2d::Constant(2.0));
      for (const DrawnBranch& other : branches_)
        if (other.branch != own.branch && other.distance(around, 1.0) <= 0.0)
          return false;
    }
    return true;
  }

  const std::vector<DrawnBranch>& branches_;
  const PictureView& view_;
  std::vector<Rectangle> boxes_;
  std::vector<Leader> leaders_;
};

/** Takes the place of an earlier view again. */
bool takeAgain(const PlacedName& name, const DrawnBranch& drawn, const PictureView& view, PlaceSearch& search)
{
  if (view.depth(name.end) <= kSmallestDepth || view.depth(name.end) > view.reach)
    return false;
  const Eigen::Vector2d end = view.project(name.end);
  return std::abs(end.x()) <= 0.5 * view.width && std::abs(end.y()) <= 0.5 * view.height &&
         search.take(drawn, end, name.offset);
}

}  // namespace

Rectangle PlacedName::boxInside(const PictureView& view) const
{
  const Rectangle at = box(view);
  const Eigen::Vector2d half = 0.5 * Eigen::Vector2d(view.width, view.height);
  Eigen::Vector2d shift = (-half - at.low).cwiseMax(0.0) - (at.high - half).cwiseMax(0.0);
  if (at.low.x() + shift.x() < view.legend_width - half.x())
    shift.y() = std::max(shift.y(), view.legend_height - half.y() - at.low.y());
  return {at.low + shift, at.high + shift};
}

std::vector<PlacedName> placeNames(const std::vector<BranchToName>& branches, const PictureView& view,
                                   const std::vector<PlacedName>& before)
{
  std::vector<DrawnBranch> drawn;
  drawn.reserve(branches.size());
  for (const BranchToName& branch : branches)
    drawn.push_back(draw(branch, view));
  std::vector<std::size_t> order(drawn.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b)
                   {
                     if (branches[a].comes_first != branches[b].comes_first)
                       return branches[a].comes_first;
                     return drawn[a].length() > drawn[b].length();
                   });
  PlaceSearch search(drawn, view);
  std::vector<PlacedName> names;
  for (const std::size_t index : order)
  {
    const DrawnBranch& own = drawn[index];
    const BranchToName& branch = branches[index];
    if (branch.text.empty() || own.length() < branch.size.y())
      continue;
    const auto earlier =
        std::find_if(before.begin(), before.end(), [&](const PlacedName& name) { return name.text == branch.text; });
    if (earlier != before.end() && takeAgain(*earlier, own, view, search))
    {
      names.push_back(*earlier);
      names.back().size = branch.size;
      continue;
    }
    for (const Candidate& candidate : candidatesOf(own, view))
      if (search.take(own, candidate.place, candidate.offset))
      {
        names.push_back({branch.text, branch.size, candidate.end, candidate.offset});
        break;
      }
  }
  return names;
}

}  // namespace endovascular_sim::visualization
