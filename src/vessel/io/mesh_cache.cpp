#include "vessel/io/mesh_cache.h"

#include <array>
#include <cstring>

#include "common/error.h"
#include "common/file/binary_file.h"

namespace endovascular_sim::vessel
{
namespace
{

using Counts = std::array<std::uint64_t, 2>;  // of vertices and triangles

static_assert(sizeof(Eigen::Vector3d) == 24 && sizeof(Eigen::Vector3i) == 12);

/** Fills a vector with the bytes at @p at, and advances it. */
template <typename T>
void take(const char*& at, std::uint64_t count, std::vector<T>& values)
{
  values.resize(count);
  std::memcpy(static_cast<void*>(values.data()), at, sizeof(T) * count);
  at += sizeof(T) * count;
}

}  // namespace

std::optional<geometry::TriangleMesh> readCachedMesh(const std::string& file, std::uint64_t key)
{
  const std::optional<std::string> bytes = readCacheFile(file, key);
  Counts counts{};
  if (!bytes || bytes->size() < sizeof counts)
    return std::nullopt;
  std::memcpy(&counts, bytes->data(), sizeof counts);
  const std::uint64_t limit = 1ULL << 32U;
  if (counts[0] > limit || counts[1] > limit || bytes->size() != sizeof counts + 24 * counts[0] + 12 * counts[1])
    return std::nullopt;
  const char* at = bytes->data() + sizeof counts;
  geometry::TriangleMesh mesh;
  take(at, counts[0], mesh.vertices);
  take(at, counts[1], mesh.triangles);
  return mesh;
}

bool writeCachedMesh(const std::string& file, std::uint64_t key, const geometry::TriangleMesh& mesh)
{
  const Counts counts{mesh.vertices.size(), mesh.triangles.size()};
  try
  {
    writeCacheFile(file, key, {bytesOf(counts), bytesOf(mesh.vertices), bytesOf(mesh.triangles)});
    return true;
  }
  catch (const InputError&)
  {
    return false;
  }
}

}  // namespace endovascular_sim::vessel
