#include "fluoroscopy/patient/volume/volume_file.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "common/hash.h"
#include "common/input_file.h"
#include "common/output_file.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const char* const kRemedy = "give the path of a density volume (.evsvol)";

struct Header
{
  std::array<char, 8> magic{'e', 'v', 's', 'v', 'o', 'l', '\r', '\n'};
  std::uint32_t version = 1;
  std::uint32_t header_size = 192;
  std::uint64_t key = 0;
  std::uint64_t content_hash = 0;
  std::array<std::int32_t, 4> size{};  // the fourth is padding
  std::array<double, 3> spacing{};
  std::array<double, 3> origin{};
  std::array<double, 9> axes{};
  double tissue_step = DensityVolume::kTissueStep;
  double bone_step = DensityVolume::kBoneStep;
  std::uint64_t reserved = 0;
};

static_assert(sizeof(Header) == 192);

image::VolumeGrid gridOf(const Header& header)
{
  image::VolumeGrid grid;
  for (int i = 0; i < 3; ++i)
  {
    const auto at = static_cast<std::size_t>(i);
    grid.size[i] = header.size[at];
    grid.spacing[i] = header.spacing[at];
    grid.origin[i] = header.origin[at];
    for (int j = 0; j < 3; ++j)
      grid.axes(i, j) = header.axes[static_cast<std::size_t>(3 * i + j)];
  }
  return grid;
}

/** Hash of header and voxels; a damaged header is found as well as a damaged voxel. */
std::uint64_t contentHash(Header header, const std::vector<std::uint16_t>& voxels)
{
  header.content_hash = 0;
  Hash64 hash;
  hash.add(&header, sizeof header);
  hash.add(voxels.data(), 2 * voxels.size());
  return hash.value();
}

Header headerOf(const DensityVolume& volume, std::uint64_t key)
{
  Header header;
  header.key = key;
  const image::VolumeGrid& grid = volume.grid();
  for (int i = 0; i < 3; ++i)
  {
    const auto at = static_cast<std::size_t>(i);
    header.size[at] = grid.size[i];
    header.spacing[at] = grid.spacing[i];
    header.origin[at] = grid.origin[i];
    for (int j = 0; j < 3; ++j)
      header.axes[static_cast<std::size_t>(3 * i + j)] = grid.axes(i, j);
  }
  header.content_hash = contentHash(header, volume.voxels());
  return header;
}

Header readHeader(std::ifstream& in, const std::string& file)
{
  Header header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != Header().magic)
    throw InputError(file, "", std::string("is not a density volume; ") + kRemedy);
  if (header.version != Header().version || header.header_size != sizeof header ||
      header.tissue_step != DensityVolume::kTissueStep || header.bone_step != DensityVolume::kBoneStep)
    throw InputError(file, "version",
                     "is " + std::to_string(header.version) + ", but this program reads version " +
                         std::to_string(Header().version) + "; import the volume again");
  return header;
}

void requireSize(const Header& header, const std::string& file)
{
  std::uint64_t expected = 2;
  for (int i = 0; i < 3; ++i)
  {
    const std::int32_t side = header.size[static_cast<std::size_t>(i)];
    if (side < 2 || side > DensityVolume::kMaxSide)
      throw InputError(file, "size", "must lie between 2 and 2048 voxels along each axis; import the volume again");
    expected *= static_cast<std::uint64_t>(side);
  }
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(file, code);
  if (code || size != sizeof header + expected)
    throw InputError(file, "",
                     "has " + std::to_string(size) + " bytes instead of " + std::to_string(sizeof header + expected) +
                         ": it is truncated or damaged; copy or import it again");
}

}  // namespace

void writeVolume(const std::string& file, const DensityVolume& volume, std::uint64_t key)
{
  const std::string temporary = file + "." + std::to_string(getpid()) + ".part";
  const Header header = headerOf(volume, key);
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(reinterpret_cast<const char*>(volume.voxels().data()), static_cast<std::streamsize>(volume.memory()));
    out.close();
    if (!out)
    {
      const InputError error = writeError(file);
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
      throw error;
    }
  }
  std::error_code code;
  std::filesystem::rename(temporary, file, code);
  if (code)
  {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw InputError(file, "", "cannot be written: " + code.message());
  }
}

DensityVolume readVolume(const std::string& file)
{
  std::ifstream in = openInputFile(file, kRemedy, std::ios::binary);
  const Header header = readHeader(in, file);
  requireSize(header, file);
  DensityVolume volume(gridOf(header), file);
  in.read(reinterpret_cast<char*>(volume.voxels().data()), static_cast<std::streamsize>(volume.memory()));
  if (!in || contentHash(header, volume.voxels()) != header.content_hash)
    throw InputError(file, "", "is damaged (its checksum differs); copy or import it again");
  return volume;
}

std::optional<DensityVolume> readCachedVolume(const std::string& file, std::uint64_t key)
{
  std::ifstream in(file, std::ios::binary);
  Header header;
  if (!in || !in.read(reinterpret_cast<char*>(&header), sizeof header) || header.key != key)
    return std::nullopt;
  in.close();
  try
  {
    return readVolume(file);
  }
  catch (const InputError&)
  {
    return std::nullopt;
  }
}

}  // namespace endovascular_sim::fluoroscopy
