#include "fluoroscopy/projection/x_ray_treatment.h"

#include <cmath>
#include <utility>

namespace endovascular_sim::fluoroscopy
{

XRayWire balloonWire(const std::vector<Eigen::Vector3d>& axis, const std::vector<double>& radius,
                     const DeviceDensity& filling)
{
  XRayWire wire;
  wire.nodes.push_back(axis.front());
  for (std::size_t k = 0; k + 1 < axis.size(); ++k)
    appendEdge(wire, axis[k + 1], {{0.5 * (radius[k] + radius[k + 1]), filling}});
  return wire;
}

std::vector<XRayWire> strutWires(const std::vector<std::vector<Eigen::Vector3d>>& lines, double thickness,
                                 const DeviceDensity& metal)
{
  const WireProfile profile = {{thickness / std::sqrt(M_PI), metal}};
  std::vector<XRayWire> wires;
  for (const std::vector<Eigen::Vector3d>& line : lines)
    // Every strut is a separate wire: at these acute angles, mitre joints would extend far beyond the corners.
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
    {
      XRayWire strut;
      strut.nodes.push_back(line[k]);
      appendEdge(strut, line[k + 1], profile);
      wires.push_back(std::move(strut));
    }
  return wires;
}

void moveWires(const motion::MotionMap& map, std::vector<XRayWire>& wires)
{
  if (map.resting())
    return;
  std::vector<Eigen::Vector3d> moved;
  for (XRayWire& wire : wires)
  {
    map.positions(wire.nodes, moved);
    wire.nodes = moved;
  }
}

}  // namespace endovascular_sim::fluoroscopy
