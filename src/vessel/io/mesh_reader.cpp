#include "vessel/io/mesh_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "common/error.h"

namespace endovascular_sim::vessel
{
namespace
{

std::string lowerCaseExtension(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void requireReadableFile(const std::string& path, double unit)
{
  if (!(unit > 0.0) || !std::isfinite(unit))
    throw InputError(path, "unit", "must be positive, e.g. 0.001 for a mesh in millimetres");
  const std::string extension = lowerCaseExtension(path);
  if (extension != ".obj" && extension != ".stl" && extension != ".ply")
    throw InputError(path, "", "unknown mesh format \"" + extension + "\"; give an .obj, .stl or .ply file");
  std::error_code code;
  if (!std::filesystem::exists(path, code))
    throw InputError(path, "", "no such file");
  if (std::filesystem::is_directory(path, code))
    throw InputError(path, "", "is a directory, not a mesh file");
  if (!std::ifstream(path))
    throw InputError(path, "", "cannot be opened for reading; check its permissions");
  if (std::filesystem::file_size(path, code) == 0)
    throw InputError(path, "", "is empty");
}

/** Collects triangles and welds vertices with bitwise equal coordinates. */
class WeldingCollector
{
public:
  explicit WeldingCollector(double unit) : unit_(unit) {}

  int vertex(const aiVector3D& v)
  {
    // Adding zero maps −0 to +0: both compare equal, but differ in the mesh's hash.
    const std::array<float, 3> key{v.x + 0.0F, v.y + 0.0F, v.z + 0.0F};
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<int>(mesh.vertices.size()));
    if (is_new)
      mesh.vertices.emplace_back(unit_ * key[0], unit_ * key[1], unit_ * key[2]);
    return entry->second;
  }

  geometry::TriangleMesh mesh;

private:
  double unit_;
  std::map<std::array<float, 3>, int> index_;
};

void collect(const aiMesh& part, const std::string& path, WeldingCollector& out)
{
  for (unsigned int i = 0; i < part.mNumVertices; ++i)
  {
    const aiVector3D& v = part.mVertices[i];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      throw InputError(path, "vertex " + std::to_string(i),
                       "has a coordinate that is not a finite number; export the mesh again");
  }
  for (unsigned int f = 0; f < part.mNumFaces; ++f)
  {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3)  // points and lines
      continue;
    Eigen::Vector3i t;
    for (int k = 0; k < 3; ++k)
      t[k] = out.vertex(part.mVertices[face.mIndices[k]]);
    out.mesh.triangles.push_back(t);
  }
}

}  // namespace

geometry::TriangleMesh readMesh(const std::string& path, double unit)
{
  requireReadableFile(path, unit);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0U)
    throw InputError(path, "", std::string("cannot be read as a mesh: ") + importer.GetErrorString());

  WeldingCollector collector(unit);
  for (unsigned int m = 0; m < scene->mNumMeshes; ++m)
    collect(*scene->mMeshes[m], path, collector);
  if (collector.mesh.triangles.empty())
    throw InputError(path, "", "has no triangles; export the vessel's surface, not points or lines");
  return std::move(collector.mesh);
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
