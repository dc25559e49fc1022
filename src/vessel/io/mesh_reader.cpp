#include "vessel/io/mesh_reader.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "vessel/io/file_extension.h"
#include "vessel/io/mesh_builder.h"
#include "vessel/io/obj_reader.h"
#include "vessel/io/ply_reader.h"
#include "vessel/io/stl_reader.h"
#include "vessel/io/vtk_poly_data.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{2} << 30;  // 2 GiB: about 20 million triangles

}  // namespace

std::string readMeshFile(const std::string& path)
{
  std::error_code code;
  if (!std::filesystem::exists(path, code))
    throw InputError(path, "", "no such file");
  if (std::filesystem::is_directory(path, code))
    throw InputError(path, "", "is a directory, not a mesh file");
  if (!std::filesystem::is_regular_file(path, code))
    throw InputError(path, "", "is not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code || size == 0)
    throw InputError(path, "", code ? "cannot be opened for reading; check its permissions" : "is empty");
  if (size > kMaxBytes)
    throw InputError(path, "", "is larger than 2 GiB; reduce the mesh");
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError(path, "", "cannot be opened for reading; check its permissions");
  return bytes;
}

geometry::TriangleMesh readMesh(const std::string& path, double unit, const ProgressReport& progress,
                                MeshRemarks* remarks)
{
  if (!(unit > 0.0) || !std::isfinite(unit))
    throw InputError(path, "unit", "must be positive, e.g. 0.001 for a mesh in millimetres");
  const std::string extension = lowerCaseExtension(path);
  if (extension != ".obj" && extension != ".stl" && extension != ".ply" && !isVtkFile(path))
    throw InputError(path, "",
                     "unknown mesh format \"" + extension + "\"; give an .obj, .stl, .ply, .vtp or .vtk file");
  const std::string bytes = readMeshFile(path);
  MeshBuilder builder(path, unit, bytes.size(), progress);
  if (extension == ".obj")
    readObj(bytes, path, builder);
  else if (extension == ".stl")
    readStl(bytes, path, builder);
  else if (extension == ".ply")
    readPly(bytes, path, builder);
  else
    addSurface(readVtkPolyData(bytes, path), builder);
  geometry::TriangleMesh mesh = builder.build();
  if (remarks != nullptr)
    *remarks = builder.remarks();
  return mesh;
}

void writeObj(const geometry::TriangleMesh& mesh, const std::string& path)
{
  std::ofstream out(path);
  out.precision(9);
  for (const Eigen::Vector3d& v : mesh.vertices)
    out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const Eigen::Vector3i& t : mesh.triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  out.close();
  if (!out)
    throw InputError(path, "", "cannot be written");
}

}  // namespace endovascular_sim::vessel
