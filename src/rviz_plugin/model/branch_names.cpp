#include "rviz_plugin/model/branch_names.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "rviz_plugin/model/message_points.h"
#include "visualization/tube_surface.h"
#include "visualization/wall_surface.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kSurroundings = 1.0;    ///< that a name keeps free of the vessel, relative to the height
constexpr double kGap = 0.5;             ///< between wall and name, relative to the height of the letters
constexpr double kShortest = 2.0;        ///< of a branch with a name, relative to the height of the letters
constexpr double kSmallestDepth = 5e-3;  ///< of a point in the picture [m]
constexpr double kShares[] = {0.6, 0.75, 0.45, 0.9, 0.3, 0.15};  ///< places of a name along its branch

/** Width of a text, relative to the height of its letters: advance widths of Liberation Sans. */
double widthOf(const std::string& text)
{
  constexpr double kTextureShare = 0.87;  // of the height of a line, as rviz draws it
  double width = 0.0;
  for (const char letter : text)
    width += std::strchr("ijl", letter) != nullptr   ? 0.22
             : std::strchr("ftr", letter) != nullptr ? 0.3
             : std::strchr("mw", letter) != nullptr  ? 0.8
             : letter == ' '                         ? 0.67
                                                     : 0.56;
  return kTextureShare * width;
}

/** Rectangle in the picture [pixels]. */
struct Rectangle
{
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();

  Rectangle() = default;
  Rectangle(const Eigen::Vector2d& low_corner, const Eigen::Vector2d& high_corner) : low(low_corner), high(high_corner)
  {
  }

  bool overlaps(const Rectangle& other) const
  {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
  bool contains(const Eigen::Vector2d& point) const
  {
    return (low.array() < point.array()).all() && (point.array() < high.array()).all();
  }
};

/** Branch in the picture: its points that lie before the eye. */
struct DrawnBranch
{
  std::string text;                     ///< empty: without a name
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<Eigen::Vector2d> places;  ///< [pixels]
  std::vector<double> radii;            ///< [pixels]
  std::vector<double> arcs;             ///< lengths in the picture [pixels]
};

DrawnBranch draw(const VesselCentrelineBranch& branch, const PictureView& view)
{
  DrawnBranch drawn;
  std::vector<Eigen::Vector3d> points;
  toEigen(branch.points, points);
  const std::vector<double> radii(branch.radii.begin(), branch.radii.end());
  if (visualization::problemOfTube(points, radii) != nullptr)
    return drawn;
  if (!branch.name.empty() && branch.name.rfind("branch_", 0) != 0)
    drawn.text = visualization::branchLabel(branch.name);
  const Eigen::Array2d half = Eigen::Array2d(view.width, view.height) / 2.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (view.depth(points[i]) < kSmallestDepth)
      continue;
    const Eigen::Vector2d place = view.project(points[i]);
    if ((place.array().abs() > half).any())
      continue;
    drawn.arcs.push_back(drawn.places.empty() ? 0.0 : drawn.arcs.back() + (place - drawn.places.back()).norm());
    drawn.points.push_back(points[i]);
    drawn.places.push_back(place);
    drawn.radii.push_back(radii[i] * view.focal / view.depth(points[i]));
  }
  return drawn;
}

/** Free place that covers the fewest points of the vessel. */
class PlaceSearch
{
public:
  PlaceSearch(const std::vector<DrawnBranch>& branches, const PictureView& view, double letters)
    : branches_(branches), view_(view), letters_(letters)
  {
  }

  std::optional<BranchName> place(const DrawnBranch& branch)
  {
    const double width = letters_ * widthOf(branch.text);
    const Eigen::Vector2d middle(0.0, 0.5 * letters_);
    std::optional<BranchName> best;
    Rectangle best_rectangle;
    std::size_t fewest = 0;
    for (const double share : kShares)
      for (const bool is_right : {true, false})
      {
        const auto at = std::lower_bound(branch.arcs.begin(), branch.arcs.end(), share * branch.arcs.back());
        const auto i = static_cast<std::size_t>(at - branch.arcs.begin());
        const double beside = branch.radii[i] + kGap * letters_;
        const double shift = is_right ? beside : -beside - width;
        const Eigen::Vector2d begin = branch.places[i] + Eigen::Vector2d(shift, 0.0);
        const Rectangle rectangle(begin - middle, begin + middle + Eigen::Vector2d(width, 0.0));
        if (!isFree(rectangle))
          continue;
        const std::size_t covered = coveredPoints(rectangle);
        if (best && covered >= fewest)
          continue;
        const double pixel = view_.depth(branch.points[i]) / view_.focal;
        best = BranchName{branch.text, branch.points[i] + shift * pixel * view_.right, letters_ * pixel};
        best_rectangle = rectangle;
        fewest = covered;
      }
    if (best)
      taken_.push_back(best_rectangle);
    return best;
  }

private:
  bool isFree(const Rectangle& rectangle) const
  {
    const Eigen::Vector2d half = 0.5 * Eigen::Vector2d(view_.width, view_.height);
    const Eigen::Vector2d legend_end(view_.legend_width - half.x(), view_.legend_height - half.y());
    if (rectangle.low.x() < legend_end.x() && rectangle.low.y() < legend_end.y())
      return false;
    const bool is_inside =
        (rectangle.low.array() > -half.array()).all() && (rectangle.high.array() < half.array()).all();
    return is_inside && std::none_of(taken_.begin(), taken_.end(),
                                     [&](const Rectangle& other) { return rectangle.overlaps(other); });
  }

  std::size_t coveredPoints(const Rectangle& rectangle) const
  {
    std::size_t covered = 0;
    for (const DrawnBranch& branch : branches_)
      for (std::size_t i = 0; i < branch.places.size(); ++i)
      {
        const Eigen::Vector2d radius = Eigen::Vector2d::Constant(branch.radii[i] + kSurroundings * letters_);
        covered += Rectangle(rectangle.low - radius, rectangle.high + radius).contains(branch.places[i]) ? 1 : 0;
      }
    return covered;
  }

  const std::vector<DrawnBranch>& branches_;
  const PictureView& view_;
  double letters_;
  std::vector<Rectangle> taken_;
};

}  // namespace

std::vector<BranchName> branchNames(const VesselCentreline& message, const PictureView& view, double letters)
{
  std::vector<DrawnBranch> branches;
  for (const VesselCentrelineBranch& branch : message.branches)
    branches.push_back(draw(branch, view));
  std::stable_sort(branches.begin(), branches.end(),
                   [](const DrawnBranch& a, const DrawnBranch& b)
                   { return (a.arcs.empty() ? 0.0 : a.arcs.back()) > (b.arcs.empty() ? 0.0 : b.arcs.back()); });
  PlaceSearch search(branches, view, letters);
  std::vector<BranchName> names;
  for (const DrawnBranch& branch : branches)
  {
    if (branch.text.empty() || branch.arcs.empty() || branch.arcs.back() < kShortest * letters)
      continue;
    if (const std::optional<BranchName> name = search.place(branch))
      names.push_back(*name);
  }
  return names;
}

}  // namespace endovascular_sim::rviz_plugin
