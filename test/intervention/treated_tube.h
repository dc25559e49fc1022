#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "common/units.h"
#include "instrument/instrument.h"
#include "intervention/shaft_line.h"
#include "intervention/vessel_dilatation.h"
#include "vessel/anatomy/tube.h"
#include "vessel/lesion/add_lesions.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::intervention
{

constexpr double kTubeRadius = 1.5e-3;  // [m]
constexpr double kLesion = 0.03;        // arc length of the throat [m]
using units::kAtmosphere;

/** Straight tube of 3 mm diameter along z with a lesion of 10 mm. Its centreline begins at the cap. */
inline vessel::Vessel tubeWithLesion(double grade, double radius = kTubeRadius)
{
  vessel::TubeShape shape;
  shape.radius = radius;
  shape.facets_around = 48;
  shape.facet_length = 0.3e-3;
  shape.pieces = {{0.06, 0.0, 0.0}};
  shape.position = {0.0, 0.0, vessel::kTubeRunIn * radius};  // z is the arc length of the centreline
  vessel::Vessel vessel;
  vessel.source = "tube";
  vessel.mesh = vessel::tubeMesh(shape);
  vessel.centreline = vessel::tubeCentreline(shape);
  vessel::Lesion lesion;
  lesion.branch = "tube";
  lesion.from_start = kLesion;
  lesion.length = 0.01;
  lesion.grade = grade;
  vessel::addLesions(vessel, {lesion}, "test");
  return vessel;
}

/** Balloon of 15 mm length with a diameter of 3 mm at 8 atm and 3.2 mm at 16 atm. */
inline instrument::Balloon balloon()
{
  instrument::Balloon balloon;
  balloon.from_tip = 5e-3;
  balloon.length = 15e-3;
  balloon.folded_diameter = 0.9e-3;
  balloon.compliance = {{2.0 * kAtmosphere, 2.4e-3}, {8.0 * kAtmosphere, 3.0e-3}, {16.0 * kAtmosphere, 3.2e-3}};
  balloon.nominal_pressure = 8.0 * kAtmosphere;
  balloon.rated_burst_pressure = 14.0 * kAtmosphere;
  balloon.burst_pressure = 20.0 * kAtmosphere;
  balloon.inflation_time = 0.5;
  balloon.deflation_time = 3.0;
  return balloon;
}

inline instrument::Stent stent()
{
  instrument::Stent stent;
  stent.crimped_diameter = 1.1e-3;
  stent.nominal_diameter = 3.0e-3;
  stent.strut_thickness = 0.09e-3;
  stent.recoil = 0.05;
  stent.expansion = {{0.92e-3, 14.2e-3}, {3.0e-3, 14.0e-3}, {3.5e-3, 13.6e-3}};
  return stent;
}

/** Shaft on the tube's axis with the centre of the balloon at @p middle [m]. */
inline ShaftLine shaftAt(double middle, double aside = 0.0)
{
  std::vector<double> from_tip;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= 40; ++k)
  {
    from_tip.push_back(k * 1e-3);
    points.emplace_back(aside, 0.0, middle + 12.5e-3 - k * 1e-3);
  }
  return ShaftLine(from_tip, points);
}

/** Least and largest distance of the wall from the tube's axis between two positions along it [m]. */
inline std::pair<double, double> wallBetween(const geometry::TriangleMesh& mesh, double begin, double end)
{
  std::pair<double, double> radii{1.0, 0.0};
  for (const Eigen::Vector3d& v : mesh.vertices)
    if (v.z() > begin && v.z() < end)
    {
      radii.first = std::min(radii.first, v.head<2>().norm());
      radii.second = std::max(radii.second, v.head<2>().norm());
    }
  return radii;
}

}  // namespace endovascular_sim::intervention
