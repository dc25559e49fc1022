#include "vessel/io/vtk_poly_data.h"

#include "vessel/io/file_extension.h"
#include "vessel/io/vtk_legacy_reader.h"
#include "vessel/io/vtp_reader.h"

namespace endovascular_sim::vessel
{

std::vector<long long> VtkCells::cell(std::size_t k) const
{
  const std::size_t begin = k == 0 ? 0 : ends[k - 1];
  return {points.begin() + static_cast<std::ptrdiff_t>(begin), points.begin() + static_cast<std::ptrdiff_t>(ends[k])};
}

VtkPolyData readVtkPolyData(std::string_view bytes, const std::string& path)
{
  return lowerCaseExtension(path) == ".vtp" ? readVtp(bytes, path) : readLegacyVtk(bytes, path);
}

bool isVtkFile(const std::string& path)
{
  const std::string extension = lowerCaseExtension(path);
  return extension == ".vtp" || extension == ".vtk";
}

bool namesRadii(const std::string& array)
{
  return array == "MaximumInscribedSphereRadius" || array == "Radius";
}

void addSurface(const VtkPolyData& data, MeshBuilder& mesh)
{
  mesh.readSpace(data.space);
  for (const Eigen::Vector3d& point : data.points)
    mesh.addVertex(point);
  for (std::size_t k = 0; k < data.polygons.size(); ++k)
    mesh.addFace(data.polygons.cell(k));
  for (std::size_t k = 0; k < data.strips.size(); ++k)
  {
    const std::vector<long long> strip = data.strips.cell(k);
    for (std::size_t i = 2; i < strip.size(); ++i)
      mesh.addFace(i % 2 == 0 ? std::vector<long long>{strip[i - 2], strip[i - 1], strip[i]}
                              : std::vector<long long>{strip[i - 1], strip[i - 2], strip[i]});
  }
}

}  // namespace endovascular_sim::vessel
