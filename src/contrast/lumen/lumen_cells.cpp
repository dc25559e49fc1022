#include "contrast/lumen/lumen_cells.h"

#include <Eigen/Geometry>

#include <stdexcept>

namespace endovascular_sim::contrast
{

bool LumenCells::fits(const geometry::TriangleMesh& mesh) const
{
  return mesh.vertices.size() == mesh_vertices && mesh.triangles == triangles;
}

std::vector<Eigen::Vector3d> LumenCells::place(const std::vector<Eigen::Vector3d>& vertices) const
{
  if (vertices.size() != mesh_vertices)
    throw std::invalid_argument("lumen: the positions are not those of its mesh");
  std::vector<Eigen::Vector3d> positions = vertices;
  positions.reserve(mesh_vertices + cuts.size());
  for (const CutVertex& cut : cuts)
  {
    const Eigen::Vector3d& from = positions[static_cast<std::size_t>(cut.from)];
    positions.emplace_back(from + cut.weight * (positions[static_cast<std::size_t>(cut.to)] - from));
  }
  return positions;
}

std::vector<double> LumenCells::partVolumes(const std::vector<Eigen::Vector3d>& positions) const
{
  const auto cone = [&positions](const Eigen::Vector3i& t)
  {
    const Eigen::Vector3d& origin = positions.front();  // near the vessel, against rounding
    const Eigen::Vector3d a = positions[static_cast<std::size_t>(t[0])] - origin;
    const Eigen::Vector3d b = positions[static_cast<std::size_t>(t[1])] - origin;
    const Eigen::Vector3d c = positions[static_cast<std::size_t>(t[2])] - origin;
    return a.dot(b.cross(c)) / 6.0;
  };
  std::vector<double> result(parts, 0.0);
  for (const WallPiece& wall : walls)
    result[static_cast<std::size_t>(wall.part)] += cone(wall.corners);
  for (const LumenCap& cap : caps)
  {
    const double volume = cone(cap.corners);
    result[static_cast<std::size_t>(cap.plus)] += volume;
    result[static_cast<std::size_t>(cap.minus)] -= volume;
  }
  return result;
}

std::vector<double> LumenCells::partConcentrations(const std::vector<double>& cells) const
{
  if (cells.size() != part_of_cell.size())
    throw std::invalid_argument("lumen: one concentration is needed for each cell");
  std::vector<double> result(parts, 0.0);
  for (std::size_t k = 0; k < cells.size(); ++k)
    result[static_cast<std::size_t>(part_of_cell[k])] += of_part[k] * cells[k];
  return result;
}

}  // namespace endovascular_sim::contrast
