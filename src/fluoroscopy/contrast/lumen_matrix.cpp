#include "fluoroscopy/contrast/lumen_matrix.h"

#include <algorithm>
#include <cmath>

#include "fluoroscopy/contrast/lumen_surface.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kNoLength = 1e-12;  // rounding of depths that cancel [m]

/** Stable sorting by insertion: there are few hits of a ray, mostly in order. */
template <typename Iterator>
void sortByPart(Iterator begin, Iterator end)
{
  for (Iterator next = begin; next != end; ++next)
  {
    Iterator place = next;
    while (place != begin && next->part < (place - 1)->part)
      --place;
    std::rotate(place, next, next + 1);
  }
}

}  // namespace

void LumenMatrix::collect(const XRayGeometry& geometry, const contrast::LumenCells& lumen,
                          const std::vector<Corner>& corners, const std::vector<char>& is_selected)
{
  const double detector_depth = geometry.pose().source_to_detector;
  const int pixels = geometry.pixels();
  hits_.clear();
  const auto isSelected = [&is_selected](int part) { return is_selected[static_cast<std::size_t>(part)] != 0; };
  const auto add = [&](int row, int column, int part, double depth)
  {
    if (isSelected(part))
      hits_.push_back({static_cast<std::uint32_t>(row * pixels + column), part, depth});
  };
  for (const contrast::WallPiece& piece : lumen.walls)
    if (isSelected(piece.part))
      coveredByPiece(lumen, piece, corners, pixels,
                     [&](int row, int column, double inverse_depth, double sign)
                     { add(row, column, piece.part, sign * std::min(1.0 / inverse_depth, detector_depth)); });
  for (const contrast::LumenCap& cap : lumen.caps)
    if (isSelected(cap.plus) || isSelected(cap.minus))
      coveredPixels(corners[static_cast<std::size_t>(cap.corners[0])],
                    corners[static_cast<std::size_t>(cap.corners[1])],
                    corners[static_cast<std::size_t>(cap.corners[2])], pixels,
                    [&](int row, int column, double inverse_depth, double sign)
                    {
                      const double depth = sign * std::min(1.0 / inverse_depth, detector_depth);
                      add(row, column, cap.plus, depth);
                      add(row, column, cap.minus, -depth);
                    });
}

/** Adds up the depths of one ray by part. @param ray length of the ray per depth [1] */
void LumenMatrix::appendRow(std::uint32_t pixel, double ray, std::vector<Hit>::iterator begin,
                            std::vector<Hit>::iterator end)
{
  sortByPart(begin, end);
  const std::size_t before = lengths_.size();
  while (begin != end)
  {
    const int part = begin->part;
    double sum = 0.0;
    for (; begin != end && begin->part == part; ++begin)
      sum += begin->depth;
    if (std::abs(sum) <= kNoLength)
      continue;
    parts_.push_back(part);
    lengths_.push_back(static_cast<float>(sum * ray));
  }
  if (lengths_.size() == before)
    return;
  pixels_.push_back(pixel);
  begin_.push_back(static_cast<std::uint32_t>(lengths_.size()));
}

/** Makes the rows of the hits. @param ray_length of a row and a column: length of the ray per depth */
template <typename RayLength>
void LumenMatrix::sortHits(int pixels, const RayLength& ray_length)
{
  const auto side = static_cast<std::size_t>(pixels);
  std::vector<std::uint32_t> ends(side * side + 1, 0);  // at first: hits of the pixel before
  for (const Hit& hit : hits_)
    ++ends[hit.pixel + 1];
  for (std::size_t k = 1; k < ends.size(); ++k)
    ends[k] += ends[k - 1];
  sorted_.resize(hits_.size());
  for (const Hit& hit : hits_)
    sorted_[ends[hit.pixel]++] = hit;
  pixels_.clear(), parts_.clear(), lengths_.clear();
  begin_.assign(1, 0);
  std::uint32_t first = 0;
  for (std::size_t k = 0; k < side * side; ++k)
  {
    const std::uint32_t end = ends[k];
    if (end > first)
      appendRow(static_cast<std::uint32_t>(k), ray_length(k / side, k % side), sorted_.begin() + first,
                sorted_.begin() + end);
    first = end;
  }
}

void LumenMatrix::build(const XRayGeometry& geometry, const contrast::LumenCells& lumen,
                        const std::vector<Corner>& corners)
{
  collect(geometry, lumen, corners, std::vector<char>(lumen.parts, 1));
  sortHits(geometry.pixels(), [&geometry](std::size_t row, std::size_t column)
           { return geometry.ray(static_cast<double>(column), static_cast<double>(row)).norm(); });
}

void LumenMatrix::buildDepths(const XRayGeometry& geometry, const contrast::LumenCells& lumen,
                              const std::vector<Corner>& corners, const std::vector<char>& is_selected)
{
  collect(geometry, lumen, corners, is_selected);
  sortHits(geometry.pixels(), [](std::size_t, std::size_t) { return 1.0; });
}

void LumenMatrix::multiply(const std::vector<double>& concentrations, IodineImage& image) const
{
  image.clear();
  forRows(concentrations, [&image](std::uint32_t pixel, double density) { image.add(pixel, density); });
}

}  // namespace endovascular_sim::fluoroscopy
