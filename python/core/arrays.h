#pragma once

#include <cstdint>
#include <vector>

#include <pybind11/numpy.h>
#include <Eigen/Core>

#include "session/observation.h"

namespace endovascular_sim::python
{

// Rows of the structured arrays that Python sees. Members have the units of the core's structures of these names.

/** simulation::HandState */
struct HandRow
{
  double insertion, rotation, force, torque, pressure;
};

/** session::Tip */
struct TipRow
{
  double position[3];
  double frame[3][3];
  double rotation;
};

/** simulation::WallContact */
struct ForceRow
{
  double position[3], normal_force[3], friction_force[3];
  double gap;
  std::int32_t node, triangle;
};

/** contact::Feature */
struct ContactRow
{
  std::int32_t edge, triangle;
  double parameter;
  double point[3], normal[3];
  double gap, clearance_radius, stiffness, friction;
  std::int64_t id;
};

/** Registers the structured types with numpy. */
void bindRows();

/** Copies of parts of an observation. @{ */
pybind11::array_t<HandRow> handsOf(const session::Observation& observation);
pybind11::array_t<TipRow> tipsOf(const session::Observation& observation);
pybind11::array_t<ForceRow> forcesOf(const session::Observation& observation);
pybind11::array_t<ContactRow> contactsOf(const session::Observation& observation);
/** @} */

HandRow handRow(const session::Observation& observation, int instrument);
TipRow tipRow(const session::Observation& observation, int instrument);

/** Array [point, 3] of points, a copy.
 *  @param first index of the first point */
pybind11::array_t<double> pointArray(const std::vector<Eigen::Vector3d>& points, std::size_t first = 0);

/** Array [3] of a vector, a copy. */
pybind11::array_t<double> vectorArray(const Eigen::Vector3d& vector);

/** Array [row, 3] of triangles, a copy. */
pybind11::array_t<std::int32_t> triangleArray(const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::python
