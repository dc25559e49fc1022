#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "common/error.h"
#include "geometry/mesh_distance.h"
#include "test/vessel/io/mesh_files.h"
#include "vessel/io/mesh_builder.h"
#include "vessel/io/obj_reader.h"
#include "vessel/io/ply_reader.h"
#include "vessel/io/stl_reader.h"
#include "vessel/io/vtk_centreline.h"
#include "vessel/io/vtk_legacy_reader.h"
#include "vessel/io/vtp_reader.h"
#include "vessel/repair/lumen_check.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"
#include "vessel/repair/mesh_size.h"

// Mesh files of all formats, with the checks and repairs of a scene. The first byte of an input selects the format.

using namespace endovascular_sim;  // NOLINT: a program's main file

namespace
{

/** Makes a centreline of the lines of a VTK file. */
void readCentreline(const vessel::VtkPolyData& data)
{
  static const geometry::MeshDistance kWall(vessel::capsule(8, 4));
  try
  {
    for (const vessel::CentrelineBranch& branch : vessel::vtkCentreline(data, 1e-3, kWall, "mesh").branches)
      if (branch.points.size() < 2 || branch.points.size() != branch.radii.size())
        std::abort();
  }
  catch (const InputError&)
  {
    return;
  }
}

geometry::TriangleMesh read(std::uint8_t format, std::string_view bytes)
{
  vessel::MeshBuilder builder("mesh", 1e-3, bytes.size());
  switch (format % 5U)
  {
    case 0:
      vessel::readObj(bytes, "mesh", builder);
      break;
    case 1:
      vessel::readStl(bytes, "mesh", builder);
      break;
    case 2:
      vessel::readPly(bytes, "mesh", builder);
      break;
    default:
      const vessel::VtkPolyData data =
          format % 5U == 3 ? vessel::readVtp(bytes, "mesh") : vessel::readLegacyVtk(bytes, "mesh");
      readCentreline(data);
      addSurface(data, builder);
  }
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
    vessel::requirePlausibleSize(mesh, vessel::checkMesh(mesh), 1e-3, "mesh");
    mesh = vessel::repairMesh(std::move(mesh), "mesh").mesh;
    requireValid(mesh);
    vessel::requireLumen(mesh, 1e-3, "mesh");
  }
  catch (const InputError&)
  {
    return 0;
  }
  return 0;
}
