#include "fluoroscopy/projection/x_ray_treatment.h"

#include <cmath>
#include <utility>

namespace endovascular_sim::fluoroscopy
{

XRayWire balloonWire(std::vector<Eigen::Vector3d> axis, std::vector<double> radius, double attenuation)
{
  XRayWire wire;
  wire.nodes = std::move(axis);
  wire.radius = std::move(radius);
  wire.attenuation.assign(wire.nodes.size() - 1, attenuation);
  return wire;
}

std::vector<XRayWire> strutWires(const std::vector<std::vector<Eigen::Vector3d>>& lines, double thickness,
                                 double attenuation)
{
  std::vector<XRayWire> wires;
  for (const std::vector<Eigen::Vector3d>& line : lines)
    // Every strut is a separate wire: at these acute angles, mitre joints would extend far beyond the corners.
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
    {
      XRayWire strut;
      strut.nodes = {line[k], line[k + 1]};
      strut.radius.assign(2, thickness / std::sqrt(M_PI));
      strut.attenuation = {attenuation};
      wires.push_back(std::move(strut));
    }
  return wires;
}

}  // namespace endovascular_sim::fluoroscopy
