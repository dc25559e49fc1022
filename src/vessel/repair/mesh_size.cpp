#include "vessel/repair/mesh_size.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/error.h"
#include "common/text/format.h"
#include "vessel/repair/wall_probes.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kSmallestVessel = 5e-3;  // [m]
constexpr double kLargestVessel = 3.0;    // [m]
constexpr double kNarrowest = 1e-3;       // width of a lumen [m]
constexpr double kWidest = 0.12;          // [m]
constexpr double kNarrowPhantom = 3e-4;   // width of the narrowest lumen for a wire [m]
constexpr double kLongestOfNarrow = 0.5;  // length of a mesh whose narrow lumen is a mistake of the unit [m]
constexpr double kUsualWidth = 8e-3;      // [m]
constexpr double kFarthest = 10.0;        // of a vertex from the origin [m]
constexpr double kSinglePrecision = 5.96e-8;

std::string lengthText(double metres)
{
  return metres >= 0.5 ? shortNumber(metres, 3) + " m" : shortNumber(1e3 * metres, 3) + " mm";
}

/** Unit of length of mesh files. */
struct Unit
{
  double metres;
  const char* name;
};

constexpr Unit kUnits[] = {
    {1.0, "metres"}, {1e-3, "millimetres"}, {1e-2, "centimetres"}, {0.0254, "inches"}, {1e-6, "micrometres"}};

/** Units with which a mesh would be a vessel, the likeliest first: that of the lumen nearest to a usual one.
 *  @param size longest side of the bounding box [units of the file]
 *  @param width width of the lumen [units of the file]; 0: unknown */
std::vector<Unit> likelyUnits(double size, double width)
{
  std::vector<Unit> units;
  for (const Unit& unit : kUnits)
    if (size * unit.metres >= 0.02 && size * unit.metres <= 1.5 &&
        (width <= 0.0 || (width * unit.metres >= kNarrowest && width * unit.metres <= 0.06)))
      units.push_back(unit);
  if (width > 0.0)
    std::stable_sort(units.begin(), units.end(),
                     [width](const Unit& a, const Unit& b)
                     {
                       const auto oddity = [width](const Unit& unit)
                       { return std::abs(std::log(width * unit.metres / kUsualWidth)); };
                       return oddity(a) < oddity(b);
                     });
  return units;
}

/** Proposal of units, as the end of a message. */
std::string proposal(double size, double width)
{
  std::string text;
  for (const Unit& unit : likelyUnits(size, width))
  {
    const std::string number = formatted("%g", unit.metres);
    text += (text.empty() ? "; it looks like " : ", or ") + std::string(unit.name) + ": set vessel.unit: " + number;
    if (width > 0.0)
      text += " (lumen " + lengthText(width * unit.metres) + " wide, mesh " + lengthText(size * unit.metres) + " long)";
  }
  return text;
}

double sizeOf(const MeshReport& report)
{
  return (report.upper - report.lower).maxCoeff();
}

}  // namespace

void requirePlausibleSize(const geometry::TriangleMesh& mesh, const MeshReport& report, double unit,
                          const std::string& source)
{
  const double size = sizeOf(report);
  if (size >= kSmallestVessel && size <= kLargestVessel)
    return;
  // Rays need numbers whose products are finite.
  const bool is_measurable = report.invalid_faces.count == 0 && size > 1e-12 && size < 1e12;
  const double width = is_measurable ? lumenWidth(probeWall(mesh, geometry::MeshDistance(mesh))) : 0.0;
  throw InputError(source, "",
                   "its bounding box is " + lengthText(size) + " long; the size of a vessel is between " +
                       lengthText(kSmallestVessel) + " and " + lengthText(kLargestVessel) +
                       proposal(size / unit, width / unit));
}

void requirePlausibleWidth(double width, const MeshReport& report, double unit, const std::string& source)
{
  if (width <= 0.0 || (width >= kNarrowest && width <= kWidest))
    return;
  const std::vector<Unit> others = likelyUnits(sizeOf(report) / unit, width / unit);
  const bool is_mistake =
      std::any_of(others.begin(), others.end(),
                  [&](const Unit& other) { return sizeOf(report) / unit * other.metres <= kLongestOfNarrow; });
  if (width < kNarrowest && width >= kNarrowPhantom && !is_mistake)
    return;  // e.g. a phantom for microcatheters
  throw InputError(source, "",
                   "its lumen is " + lengthText(width) + " wide and its bounding box " + lengthText(sizeOf(report)) +
                       " long; a lumen for instruments is between " + lengthText(kNarrowest) + " and " +
                       lengthText(kWidest) + " wide" + proposal(sizeOf(report) / unit, width / unit));
}

std::string distanceWarning(const MeshReport& report, const std::string& source)
{
  const double farthest = std::max(report.lower.cwiseAbs().maxCoeff(), report.upper.cwiseAbs().maxCoeff());
  if (!(farthest > kFarthest))
    return "";
  const std::string text = formatted(
      ": lies %.3g m from the origin, where coordinates of single precision are rounded to %.2g um; move the "
      "mesh to the origin before its export",
      farthest, 1e6 * kSinglePrecision * farthest);
  return source + text;
}

}  // namespace endovascular_sim::vessel
