#include "image/import/image_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "common/error.h"
#include "common/text/format.h"

namespace endovascular_sim::image
{
namespace
{

constexpr double kLeast = -32768.0;   // stored value
constexpr double kLargest = 32767.0;  // stored value
constexpr double kImplausible = 1e9;  // magnitude that no scanner gives
constexpr float kBelowFat = -500.0F;  // HU; every CT holds air around the patient or in the lungs

/** @throws InputError for values that are not finite, or beyond those of any scanner */
void requirePlausible(const std::vector<float>& values, const std::string& path)
{
  std::size_t invalid = 0;
  double largest = 0.0;
  for (const float value : values)
  {
    invalid += std::isfinite(value) ? 0U : 1U;
    largest = std::max(largest, std::abs(static_cast<double>(value)));
  }
  if (invalid > 0)
    throw InputError(path, "", std::to_string(invalid) + " values are not finite; replace them before the import");
  if (largest > kImplausible)
    throw InputError(path, "",
                     "has a value of magnitude " + formatted("%.3g", largest) +
                         ", which no scanner gives; replace such values before the import");
}

bool holdsAir(const std::vector<float>& values)
{
  return std::any_of(values.begin(), values.end(), [](float value) { return value < kBelowFat; });
}

/** Recognises a mask (zero and one other value) and a label map: few natural numbers, each in coherent regions. In a
 * grey image most of the values are scattered. */
bool isLabelMap(const std::map<float, Coherence>& labels)
{
  constexpr double kCoherentLabels = 0.8;  // share of the labels
  if (labels.size() < 2 || labels.begin()->first != 0.0F)
    return false;
  if (labels.size() == 2)
    return true;
  std::size_t coherent = 0;
  for (const auto& [label, count] : labels)
    coherent += 2 * count.beside_equal >= count.voxels ? 1U : 0U;
  return static_cast<double>(coherent) >= kCoherentLabels * static_cast<double>(labels.size());
}

double medianBetween(const std::vector<float>& values, float low, float high, std::size_t& count)
{
  std::vector<float> inside;
  std::copy_if(values.begin(), values.end(), std::back_inserter(inside),
               [low, high](float value) { return value >= low && value < high; });
  count = inside.size();
  if (inside.empty())
    return 0.0;
  const auto middle = inside.begin() + static_cast<long>(inside.size() / 2);
  std::nth_element(inside.begin(), middle, inside.end());
  return *middle;
}

/** @throws InputError for a CT that is stored without its intercept: air lies at 0 and tissue at 1064 */
void requireNotRaised(const std::vector<float>& values, const std::string& path)
{
  std::size_t air = 0;
  std::size_t between = 0;  // values of fat in a CT that is not raised lie below, those of lungs mostly too
  std::size_t tissue = 0;
  const double of_air = medianBetween(values, -50.0F, 224.0F, air);
  medianBetween(values, 224.0F, 824.0F, between);
  const double of_tissue = medianBetween(values, 824.0F, 1224.0F, tissue);
  if (100 * air < values.size() || 20 * tissue < values.size() || tissue < between)
    return;
  throw InputError(path, "",
                   "seems to be a CT whose values are raised by 1024: air at " + formatted("%.0f", of_air) +
                       ", tissue at " + formatted("%.0f", of_tissue) +
                       "; give --subtract 1024 for Hounsfield units, or --modality other if it is no CT");
}

/** @throws InputError for a CT of 8-bit values without air, i.e. grey values in place of Hounsfield units */
void requireHounsfieldUnits(const ImageValues& image, const std::string& path)
{
  if (image.bits == 8 && !holdsAir(image.values))
    throw InputError(path, "",
                     "has grey values of 8 bit, which are no Hounsfield units; export the CT with 16 bit, or give "
                     "--modality other");
  if (!holdsAir(image.values))
    requireNotRaised(image.values, path);
  const auto [least, largest] = std::minmax_element(image.values.begin(), image.values.end());
  if (*least < kLeast || *largest > kLargest)
    throw InputError(path, "",
                     "has values from " + formatted("%g", *least) + " to " + formatted("%g", *largest) +
                         ", which are no Hounsfield units; replace them before the import, or give --modality other");
}

/** Modality of values whose file does not name it: air in a CT has −1000 HU. */
Modality modalityOf(const std::vector<float>& values, const std::string& path)
{
  if (holdsAir(values))
    return Modality::kCt;
  throw InputError(
      path, "",
      "has no value below -500, so it may be no CT; give --modality ct for Hounsfield units, or --modality "
      "other");
}

}  // namespace

std::map<float, Coherence> coherenceOfLabels(const ImageValues& image)
{
  constexpr std::size_t kMostLabels = 1000;
  const std::vector<float>& values = image.values;
  const auto columns = static_cast<std::size_t>(image.columns);
  std::map<float, Coherence> labels;
  auto entry = labels.end();  // of the voxel before
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    const float value = values[n];
    if (value != std::nearbyint(value))
      return {};
    if (entry == labels.end() || entry->first != value)
      entry = labels.emplace(value, Coherence()).first;
    if (labels.size() > kMostLabels)
      return {};
    Coherence& label = entry->second;
    const bool left = n % columns > 0 && values[n - 1] == value;
    const bool right = n % columns + 1 < columns && values[n + 1] == value;
    ++label.voxels;
    label.beside_equal += left || right ? 1U : 0U;
  }
  return labels;
}

std::string listedLabels(const std::map<float, Coherence>& labels)
{
  constexpr std::size_t kNamed = 24;
  std::string list;
  std::size_t number = 0;
  for (const auto& [label, count] : labels)
    if (label != 0.0F && number++ < kNamed)
      list += (list.empty() ? "" : ", ") + formatted("%.0f", label);
  return list + (number > kNamed ? " and " + std::to_string(number - kNamed) + " more" : "");
}

void storeValues(const ImageValues& image, std::optional<Modality> modality, const std::string& path, Volume& volume)
{
  const std::vector<float>& values = image.values;
  requirePlausible(values, path);
  if (const std::map<float, Coherence> labels = coherenceOfLabels(image); isLabelMap(labels))
    throw InputError(path, "",
                     "is a label map, not an image: it holds the label(s) " + listedLabels(labels) +
                         "; make a vessel of a label by vessel_segment --label N, or give the image that the labels "
                         "were made from");
  if (modality.value_or(Modality::kCt) == Modality::kCt)
    requireHounsfieldUnits(image, path);
  volume.modality = modality ? *modality : modalityOf(values, path);
  double largest = 0.0;
  bool are_integers = true;
  for (const float value : values)
  {
    largest = std::max(largest, std::abs(static_cast<double>(value)));
    are_integers = are_integers && value == std::nearbyint(value);
  }
  // The values of a CT are Hounsfield units and keep their unit.
  const bool keeps = volume.modality == Modality::kCt || (are_integers && largest <= kLargest);
  volume.scale = keeps ? 1.0 : largest / kLargest;
  volume.stored.reserve(values.size());
  for (const float value : values)
    volume.stored.push_back(static_cast<std::int16_t>(
        std::lround(std::clamp(static_cast<double>(value) / volume.scale, kLeast, kLargest))));
}

}  // namespace endovascular_sim::image
