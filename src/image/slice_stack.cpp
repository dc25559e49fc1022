#include "image/slice_stack.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::image
{
namespace
{

constexpr double kDirection = 1e-3;  // rad between orientations of one series
constexpr double kSpacing = 1e-3;    // relative difference of the spacings of one series
constexpr double kSamePlace = 0.02;  // share of the distance of slices
constexpr double kRegular = 0.05;    // largest relative deviation of the distance between slices
constexpr double kTilt = 0.5e-3;     // rad between the normal and the direction from slice to slice

Eigen::Vector3d normalOf(const Slice& slice)
{
  return slice.along_row.cross(slice.along_column).normalized();
}

/** Checks that a slice has pixels of the same size, in the same directions as the first one. */
void requireEqual(const Slice& slice, const Slice& first)
{
  if (slice.size != first.size)
    throw InputError(slice.file, "",
                     "has " + std::to_string(slice.size.x()) + " x " + std::to_string(slice.size.y()) + " pixels, " +
                         first.file + " has " + std::to_string(first.size.x()) + " x " +
                         std::to_string(first.size.y()) + "; give the slices of one series only");
  if (!((slice.spacing - first.spacing).norm() <= kSpacing * first.spacing.norm()))
    throw InputError(slice.file, "PixelSpacing", "differs from that of " + first.file + "; give one series only");
  const double turn = (slice.along_row - first.along_row).norm() + (slice.along_column - first.along_column).norm();
  if (!(turn <= kDirection))
    throw InputError(slice.file, "ImageOrientationPatient",
                     "differs from that of " + first.file +
                         "; localisers and other orientations belong to another series: remove them");
}

/** Distance between neighbouring slices: the median. */
double distanceOf(const std::vector<double>& places)
{
  std::vector<double> distances;
  for (std::size_t k = 1; k < places.size(); ++k)
    distances.push_back(places[k] - places[k - 1]);
  std::nth_element(distances.begin(), distances.begin() + static_cast<long>(distances.size() / 2), distances.end());
  return distances[distances.size() / 2];
}

void requireRegular(const std::vector<Slice>& slices, const std::vector<double>& places, double distance,
                    const std::string& source)
{
  for (std::size_t k = 1; k < places.size(); ++k)
  {
    const double step = places[k] - places[k - 1];
    if (step <= kSamePlace * distance)
      throw InputError(slices[k].file, "ImagePositionPatient",
                       "is the place of " + slices[k - 1].file +
                           " too; the folder holds a slice twice or two series: give one of them");
    if (std::abs(step - distance) > kRegular * distance)
      throw InputError(
          source, "",
          "slices are " + formatted("%.3f", 1e3 * distance) + " mm apart, but " + formatted("%.3f", 1e3 * step) +
              " mm between " + slices[k - 1].file + " and " + slices[k].file +
              ": slices are missing, or the spacing varies; export the complete series with equal spacing");
  }
}

}  // namespace

SliceStack stackSlices(std::vector<Slice> slices, const std::string& source)
{
  if (slices.size() < 2)
    throw InputError(source, "", "has " + std::to_string(slices.size()) + " slices; a volume has two or more");
  for (const Slice& slice : slices)
    requireEqual(slice, slices.front());
  const Eigen::Vector3d normal = normalOf(slices.front());
  std::sort(slices.begin(), slices.end(),
            [&normal](const Slice& a, const Slice& b) { return normal.dot(a.origin) < normal.dot(b.origin); });
  std::vector<double> places;
  for (const Slice& slice : slices)
    places.push_back(normal.dot(slice.origin));
  const double distance = distanceOf(places);
  requireRegular(slices, places, distance, source);
  const Eigen::Vector3d through = (slices.back().origin - slices.front().origin).normalized();
  const double tilt = std::atan2(through.cross(normal).norm(), through.dot(normal));
  if (tilt > kTilt)
    throw InputError(source, "ImagePositionPatient",
                     "the slices are shifted sideways: a gantry tilt of " + formatted("%.2f", tilt / units::kDegree) +
                         "°; resample the series to a straight grid first");
  SliceStack stack;
  stack.grid.size = {slices.front().size.x(), slices.front().size.y(), static_cast<int>(slices.size())};
  stack.grid.spacing = {slices.front().spacing.x(), slices.front().spacing.y(),
                        (places.back() - places.front()) / static_cast<double>(places.size() - 1)};
  stack.grid.origin = slices.front().origin;
  stack.grid.axes.col(0) = slices.front().along_row.normalized();
  stack.grid.axes.col(1) = slices.front().along_column.normalized();
  stack.grid.axes.col(2) = normal;
  requireValid(stack.grid, source);
  for (Slice& slice : slices)
    stack.files.push_back(std::move(slice.file));
  return stack;
}

}  // namespace endovascular_sim::image
