#include "image/volume_file.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "common/file/binary_file.h"
#include "common/hash.h"
#include "common/input_file.h"

namespace endovascular_sim::image
{
namespace
{

constexpr auto kRemedy = "give a file that volume_import has written";

struct Header
{
  std::array<char, 8> magic{'e', 'v', 's', 'v', 'o', 'l', '0', '1'};
  std::array<std::int32_t, 3> size{};
  std::uint32_t modality = 0;
  std::array<double, 3> spacing{};
  std::array<double, 3> origin{};
  std::array<double, 9> axes{};
  double scale = 1.0;
  std::uint64_t hash = 0;
};

static_assert(sizeof(Header) == 160);

std::uint64_t hashOf(const std::vector<std::int16_t>& values)
{
  Hash64 hash;
  hash.add(values.data(), values.size() * sizeof(std::int16_t));
  return hash.value();
}

Header headerOf(const Volume& volume)
{
  Header header;
  header.modality = static_cast<std::uint32_t>(volume.modality);
  for (int k = 0; k < 3; ++k)
  {
    header.size[k] = volume.grid.size[k];
    header.spacing[k] = volume.grid.spacing[k];
    header.origin[k] = volume.grid.origin[k];
  }
  for (int k = 0; k < 9; ++k)
    header.axes[k] = volume.grid.axes(k % 3, k / 3);
  header.scale = volume.scale;
  header.hash = hashOf(volume.stored);
  return header;
}

/** Volume of a header, without values. @throws InputError for an invalid one */
Volume volumeOf(const Header& header, const std::string& file)
{
  Volume volume;
  for (int k = 0; k < 3; ++k)
  {
    volume.grid.size[k] = header.size[k];
    volume.grid.spacing[k] = header.spacing[k];
    volume.grid.origin[k] = header.origin[k];
  }
  for (int k = 0; k < 9; ++k)
    volume.grid.axes(k % 3, k / 3) = header.axes[k];
  requireValid(volume.grid, file);
  volume.modality = static_cast<Modality>(header.modality);
  if (volume.modality != Modality::kCt && volume.modality != Modality::kOther && volume.modality != Modality::kLabels)
    throw InputError(file, "modality", "is " + std::to_string(header.modality) + "; " + kRemedy);
  volume.scale = header.scale;
  if (!std::isfinite(volume.scale) || volume.scale <= 0.0)
    throw InputError(file, "scale", std::string("must be finite and positive; ") + kRemedy);
  return volume;
}

}  // namespace

void writeVolume(const std::string& file, const Volume& volume)
{
  const Header header = headerOf(volume);
  writeBinaryFile(file, {bytesOf(header), bytesOf(volume.stored)});
}

Volume readVolume(const std::string& file)
{
  std::ifstream in = openInputFile(file, kRemedy, std::ios::binary);
  Header header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != Header().magic)
    throw InputError(file, "", std::string("is no volume of this package; ") + kRemedy);
  Volume volume = volumeOf(header, file);
  std::error_code code;
  const std::uint64_t length = std::filesystem::file_size(file, code);
  const std::uint64_t bytes = volume.grid.voxels() * sizeof(std::int16_t);
  if (code || length != sizeof header + bytes)
    throw InputError(file, "",
                     "has " + std::to_string(length) + " bytes in place of " + std::to_string(sizeof header + bytes) +
                         "; import the images again");
  volume.stored.resize(volume.grid.voxels());
  if (!in.read(reinterpret_cast<char*>(volume.stored.data()), static_cast<std::streamsize>(bytes)) ||
      hashOf(volume.stored) != header.hash)
    throw InputError(file, "", "is damaged: its values do not fit their hash; import the images again");
  return volume;
}

}  // namespace endovascular_sim::image
