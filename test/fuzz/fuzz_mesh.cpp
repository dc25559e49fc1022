#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "common/error.h"
#include "vessel/io/mesh_builder.h"
#include "vessel/io/obj_reader.h"
#include "vessel/io/ply_reader.h"
#include "vessel/io/stl_reader.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"

// Mesh files of all formats, with the checks and repairs of a scene. The first byte of an input selects the format.

using namespace endovascular_sim;  // NOLINT: a program's main file

namespace
{

geometry::TriangleMesh read(std::uint8_t format, std::string_view bytes)
{
  vessel::MeshBuilder builder("mesh", 1e-3, bytes.size());
  if (format % 3U == 0)
    vessel::readObj(bytes, "mesh", builder);
  else if (format % 3U == 1)
    vessel::readStl(bytes, "mesh", builder);
  else
    vessel::readPly(bytes, "mesh", builder);
  return builder.build();
}

void requireValid(const geometry::TriangleMesh& mesh)
{
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    if (triangle.minCoeff() < 0 || triangle.maxCoeff() >= static_cast<int>(mesh.vertices.size()))
      std::abort();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    if (!vertex.allFinite())
      std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  if (size == 0)
    return 0;
  try
  {
    geometry::TriangleMesh mesh = read(data[0], {reinterpret_cast<const char*>(data + 1), size - 1});
    requireValid(mesh);
    vessel::requirePlausibleSize(vessel::checkMesh(mesh), 1e-3, "mesh");
    requireValid(vessel::repairMesh(std::move(mesh), "mesh").mesh);
  }
  catch (const InputError&)
  {
    return 0;
  }
  return 0;
}
