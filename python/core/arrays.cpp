#include "arrays.h"

#include <algorithm>

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

void copy(const Eigen::Vector3d& from, double (&to)[3])
{
  std::copy(from.data(), from.data() + 3, to);
}

}  // namespace

void bindRows()
{
  PYBIND11_NUMPY_DTYPE(HandRow, insertion, rotation, force, torque, pressure);
  PYBIND11_NUMPY_DTYPE(TipRow, position, frame, rotation);
  PYBIND11_NUMPY_DTYPE(ForceRow, position, normal_force, friction_force, gap, node, triangle);
  PYBIND11_NUMPY_DTYPE(ContactRow, edge, triangle, parameter, point, normal, gap, clearance_radius, stiffness, friction,
                       id);
}

HandRow handRow(const session::Observation& observation, int instrument)
{
  const simulation::HandState hand = observation.hand(instrument);
  return {hand.insertion, hand.rotation, hand.force, hand.torque, hand.pressure};
}

TipRow tipRow(const session::Observation& observation, int instrument)
{
  const session::Tip tip = observation.tip(instrument);
  TipRow row{};
  copy(tip.position, row.position);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      row.frame[i][j] = tip.frame(i, j);
  row.rotation = tip.rotation;
  return row;
}

py::array_t<HandRow> handsOf(const session::Observation& observation)
{
  py::array_t<HandRow> rows(observation.instruments());
  for (int k = 0; k < observation.instruments(); ++k)
    rows.mutable_at(k) = handRow(observation, k);
  return rows;
}

py::array_t<TipRow> tipsOf(const session::Observation& observation)
{
  py::array_t<TipRow> rows(observation.instruments());
  for (int k = 0; k < observation.instruments(); ++k)
    rows.mutable_at(k) = tipRow(observation, k);
  return rows;
}

py::array_t<ForceRow> forcesOf(const session::Observation& observation)
{
  const std::vector<simulation::WallContact>& forces = observation.forces();
  py::array_t<ForceRow> rows(static_cast<py::ssize_t>(forces.size()));
  ForceRow* row = rows.mutable_data();
  for (const simulation::WallContact& force : forces)
  {
    copy(force.position, row->position);
    copy(force.normal_force, row->normal_force);
    copy(force.friction_force, row->friction_force);
    row->gap = force.gap;
    row->node = force.node;
    row->triangle = force.triangle;
    ++row;
  }
  return rows;
}

py::array_t<ContactRow> contactsOf(const session::Observation& observation)
{
  const std::vector<contact::Feature>& features = observation.contacts().features;
  py::array_t<ContactRow> rows(static_cast<py::ssize_t>(features.size()));
  ContactRow* row = rows.mutable_data();
  for (const contact::Feature& feature : features)
  {
    row->edge = feature.edge;
    row->triangle = feature.triangle;
    row->parameter = feature.parameter;
    copy(feature.point, row->point);
    copy(feature.normal, row->normal);
    row->gap = feature.gap;
    row->clearance_radius = feature.clearance_radius;
    row->stiffness = feature.stiffness;
    row->friction = feature.friction;
    row->id = feature.id;
    ++row;
  }
  return rows;
}

py::array_t<double> pointArray(const std::vector<Eigen::Vector3d>& points, std::size_t first)
{
  const auto rows = static_cast<py::ssize_t>(points.size() - std::min(first, points.size()));
  py::array_t<double> array({rows, py::ssize_t{3}});
  double* to = array.mutable_data();
  for (std::size_t k = first; k < points.size(); ++k, to += 3)
    std::copy(points[k].data(), points[k].data() + 3, to);
  return array;
}

py::array_t<double> vectorArray(const Eigen::Vector3d& vector)
{
  return py::array_t<double>(3, vector.data());
}

py::array_t<std::int32_t> triangleArray(const geometry::TriangleMesh& mesh)
{
  py::array_t<std::int32_t> array({static_cast<py::ssize_t>(mesh.triangles.size()), py::ssize_t{3}});
  std::int32_t* to = array.mutable_data();
  for (const auto& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      *to++ = triangle[k];
  return array;
}

}  // namespace endovascular_sim::python
