#include "vessel/io/mesh_cache.h"

#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace endovascular_sim::vessel
{
namespace
{

struct Header
{
  std::array<char, 8> magic{'e', 'v', 's', 'm', 'e', 's', 'h', '1'};
  std::uint64_t key = 0;
  std::uint64_t mesh_hash = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};

static_assert(sizeof(Header) == 40);
static_assert(sizeof(Eigen::Vector3d) == 24 && sizeof(Eigen::Vector3i) == 12);

}  // namespace

std::optional<geometry::TriangleMesh> readCachedMesh(const std::string& file, std::uint64_t key)
{
  std::ifstream in(file, std::ios::binary);
  Header header;
  if (!in || !in.read(reinterpret_cast<char*>(&header), sizeof header))
    return std::nullopt;
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(file, code);
  const std::uint64_t limit = 1ULL << 32U;
  if (code || header.magic != Header().magic || header.key != key || header.vertices > limit ||
      header.triangles > limit || size != sizeof header + 24 * header.vertices + 12 * header.triangles)
    return std::nullopt;
  geometry::TriangleMesh mesh;
  mesh.vertices.resize(header.vertices);
  mesh.triangles.resize(header.triangles);
  in.read(reinterpret_cast<char*>(mesh.vertices.data()), static_cast<std::streamsize>(24 * header.vertices));
  in.read(reinterpret_cast<char*>(mesh.triangles.data()), static_cast<std::streamsize>(12 * header.triangles));
  if (!in || mesh.hash() != header.mesh_hash)
    return std::nullopt;
  return mesh;
}

bool writeCachedMesh(const std::string& file, std::uint64_t key, const geometry::TriangleMesh& mesh)
{
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), code);
  const std::string temporary = file + "." + std::to_string(getpid()) + ".part";
  Header header;
  header.key = key;
  header.mesh_hash = mesh.hash();
  header.vertices = mesh.vertices.size();
  header.triangles = mesh.triangles.size();
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(reinterpret_cast<const char*>(mesh.vertices.data()), static_cast<std::streamsize>(24 * header.vertices));
    out.write(reinterpret_cast<const char*>(mesh.triangles.data()),
              static_cast<std::streamsize>(12 * header.triangles));
    out.close();
    if (!out)
    {
      std::filesystem::remove(temporary, code);
      return false;
    }
  }
  std::filesystem::rename(temporary, file, code);
  if (code)
    std::filesystem::remove(temporary, code);
  return !code;
}

}  // namespace endovascular_sim::vessel
