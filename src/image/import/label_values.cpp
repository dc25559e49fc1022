#include "image/import/label_values.h"

#include <cstddef>
#include <cstdint>
#include <map>

#include "common/error.h"

namespace endovascular_sim::image
{
namespace
{

constexpr int kMargin = 3;  // voxels around the labels

/** Stored values of the chosen labels. @throws InputError for a label that the map does not hold */
std::map<float, std::int16_t> numbersOf(const ImageValues& image, const std::vector<long>& labels,
                                        const std::string& path)
{
  const std::map<float, Coherence> held = coherenceOfLabels(image);
  if (held.empty())
    throw InputError(path, "--label",
                     "requires a label map, but this image has values that are no whole numbers, or more than 1000 of "
                     "them; give the label map, resampled without interpolation");
  std::map<float, std::int16_t> numbers;
  for (const long label : labels)
  {
    if (held.count(static_cast<float>(label)) == 0)
      throw InputError(
          path, "--label",
          "is " + std::to_string(label) + ", but the label map holds " + listedLabels(held) + "; give one of them");
    numbers.emplace(static_cast<float>(label), static_cast<std::int16_t>(numbers.size() + 1));
  }
  return numbers;
}

/** Smallest box of voxels with values, with the margin within the grid. */
void cropToValues(Volume& volume)
{
  const Eigen::Vector3i size = volume.grid.size;
  Eigen::Vector3i low = size;
  Eigen::Vector3i high = Eigen::Vector3i::Zero();
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
        if (volume.stored[volume.grid.offset(i, j, k)] != 0)
        {
          low = low.cwiseMin(Eigen::Vector3i(i, j, k));
          high = high.cwiseMax(Eigen::Vector3i(i, j, k));
        }
  low = (low.array() - kMargin).max(0);
  high = (high.array() + kMargin).min(size.array() - 1);
  VolumeGrid grid = volume.grid;
  grid.size = high - low + Eigen::Vector3i::Ones();
  grid.origin = volume.grid.position(low.cast<double>());
  std::vector<std::int16_t> stored;
  stored.reserve(grid.voxels());
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int i = low.x(); i <= high.x(); ++i)
        stored.push_back(volume.stored[volume.grid.offset(i, j, k)]);
  volume.grid = grid;
  volume.stored = std::move(stored);
}

}  // namespace

void storeLabels(const ImageValues& image, const std::vector<long>& labels, const std::string& path, Volume& volume)
{
  const std::map<float, std::int16_t> numbers = numbersOf(image, labels, path);
  volume.modality = Modality::kLabels;
  volume.scale = 1.0;
  volume.stored.reserve(image.values.size());
  for (const float value : image.values)
  {
    const auto found = numbers.find(value);
    volume.stored.push_back(found == numbers.end() ? std::int16_t{0} : found->second);
  }
  cropToValues(volume);
}

}  // namespace endovascular_sim::image
