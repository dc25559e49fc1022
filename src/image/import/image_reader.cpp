#include "image/import/image_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "common/error.h"
#include "image/import/complete_file.h"
#include "image/import/itk_image.h"
#include "image/slice_stack.h"

namespace endovascular_sim::image
{
namespace
{

constexpr double kMillimetre = 1e-3;
constexpr double kLargest = 32767.0;  // stored value
constexpr float kBelowFat = -500.0F;  // HU; every CT holds air around the patient or in the lungs

std::string megabytes(std::uint64_t bytes)
{
  return std::to_string((bytes + 999999) / 1000000) + " MB";
}

void requireMemory(std::uint64_t need, const ImportOptions& options, const std::string& path)
{
  if (need > options.memory)
    throw InputError(path, "",
                     "needs " + megabytes(need) + " of memory, the limit is " + megabytes(options.memory) +
                         "; raise --memory, or export a part of the volume");
}

Eigen::Vector3d directionOf(const ItkImage& image, unsigned axis)
{
  const std::vector<double> direction = image.direction(axis);
  return {direction.at(0), direction.at(1), direction.at(2)};
}

void requireOneComponent(const ItkImage& image, const std::string& file)
{
  if (image.components() != 1)
    throw InputError(file, "",
                     "has " + std::to_string(image.components()) +
                         " values per voxel; give an image with one, no colours or vectors");
}

/** Stores values in 16 bit. The values of a CT are Hounsfield units and keep their unit. */
void store(const std::vector<float>& values, const std::string& path, Volume& volume)
{
  double largest = 0.0;
  std::size_t invalid = 0;
  bool are_integers = true;
  for (const float value : values)
  {
    invalid += std::isfinite(value) ? 0U : 1U;
    largest = std::max(largest, std::abs(static_cast<double>(value)));
    are_integers = are_integers && value == std::nearbyint(value);
  }
  if (invalid > 0)
    throw InputError(path, "", std::to_string(invalid) + " values are not finite; replace them before the import");
  const bool keeps = volume.modality == Modality::kCt || (are_integers && largest <= kLargest);
  volume.scale = keeps ? 1.0 : largest / kLargest;
  volume.stored.reserve(values.size());
  for (const float value : values)
    volume.stored.push_back(static_cast<std::int16_t>(
        std::lround(std::clamp(static_cast<double>(value) / volume.scale, -kLargest, kLargest))));
}

bool holdsAir(const std::vector<float>& values)
{
  return std::any_of(values.begin(), values.end(), [](float value) { return value < kBelowFat; });
}

/** @throws InputError for a CT of 8-bit values without air, i.e. grey values in place of Hounsfield units */
void requireHounsfieldUnits(const std::vector<float>& values, unsigned bits, const std::string& path)
{
  if (bits == 8 && !holdsAir(values))
    throw InputError(path, "",
                     "has grey values of 8 bit, which are no Hounsfield units; export the CT with 16 bit, or give "
                     "--modality other");
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

/** Files of the wanted series of a folder. */
std::vector<std::string> seriesOf(const std::string& folder, const ImportOptions& options)
{
  std::vector<std::vector<std::string>> series = dicomSeries(folder);
  if (series.empty())
    throw InputError(folder, "",
                     "holds no DICOM images; give a folder with a DICOM series, or a file .nii, .nii.gz, .nrrd, .nhdr, "
                     ".mha or .mhd");
  std::string list;
  for (std::size_t k = 0; k < series.size(); ++k)
    list += (k == 0 ? "" : ", ") + std::to_string(k + 1) + " (" + std::to_string(series[k].size()) + " images)";
  if (options.series == 0 && series.size() > 1)
    throw InputError(folder, "",
                     "holds " + std::to_string(series.size()) + " series: " + list + "; choose one by --series N");
  if (options.series > static_cast<int>(series.size()))
    throw InputError(folder, "", "holds the series " + list + "; --series must be one of them");
  return series[static_cast<std::size_t>(std::max(1, options.series)) - 1];
}

/** Geometry of a slice. @throws InputError where the file has no spacing, position or orientation */
Slice sliceOf(const ItkImage& image, const std::string& file)
{
  requireOneComponent(image, file);
  const std::vector<std::pair<const char*, const char*>> needed = {
      {"0028|0030", "PixelSpacing"}, {"0020|0032", "ImagePositionPatient"}, {"0020|0037", "ImageOrientationPatient"}};
  for (const auto& [key, name] : needed)
    if (image.field(key).empty())
      throw InputError(file, name, "is missing; export the series with spacing, position and orientation");
  const std::vector<std::uint64_t> size = image.size();
  if (size.size() > 2 && size[2] > 1)
    throw InputError(file, "", "has several frames; export the volume as single slices, or as NIfTI");
  Slice slice;
  slice.file = file;
  slice.size = {static_cast<int>(size.at(0)), static_cast<int>(size.at(1))};
  slice.spacing = kMillimetre * Eigen::Vector2d(image.spacing(0), image.spacing(1));
  slice.origin = kMillimetre * Eigen::Vector3d(image.origin(0), image.origin(1), image.origin(2));
  slice.along_row = directionOf(image, 0);
  slice.along_column = directionOf(image, 1);
  return slice;
}

/** Checks that the values of a CT slice have a unit: ITK takes a missing slope for 1.
 *  @throws InputError naming the field */
void requireRescaling(const ItkImage& image, const std::string& file)
{
  for (const auto& [key, name] : {std::pair("0028|1053", "RescaleSlope"), std::pair("0028|1052", "RescaleIntercept")})
    if (image.field(key).empty())
      throw InputError(file, name,
                       "is missing, so the values may be no Hounsfield units; export the series with it, or give "
                       "--modality ct if they are");
}

Volume readSeries(const std::string& folder, const ImportOptions& options)
{
  std::vector<Slice> slices;
  std::string modality;
  unsigned bits = 16;
  for (const std::string& file : seriesOf(folder, options))
  {
    const ItkImage image(file, {ImageFormat::kDicom});
    slices.push_back(sliceOf(image, file));
    modality = image.field("0008|0060");
    bits = image.field("0028|0100") == "8" ? 8 : 16;
    if (modality == "CT" && !options.modality)
      requireRescaling(image, file);
  }
  const SliceStack stack = stackSlices(std::move(slices), folder);
  Volume volume;
  volume.grid = stack.grid;
  volume.modality = options.modality.value_or(modality == "CT" ? Modality::kCt : Modality::kOther);
  const std::uint64_t voxels = volume.grid.voxels();
  requireMemory(voxels * (sizeof(float) + sizeof(std::int16_t)), options, folder);
  std::vector<float> values;
  values.reserve(voxels);
  for (const std::string& file : stack.files)
    requireCompleteDicom(file);
  for (const std::string& file : stack.files)
    ItkImage(file, {ImageFormat::kDicom}).read(values);
  if (values.size() != voxels)
    throw InputError(folder, "", "its slices hold other numbers of pixels than their headers; export the series again");
  if (volume.modality == Modality::kCt)
    requireHounsfieldUnits(values, bits, folder);
  store(values, folder, volume);
  return volume;
}

/** Checks that a file has spacing and orientation, which ITK would replace by defaults.
 *  @throws InputError with the missing field */
void requireOrientation(const ItkImage& image, const std::string& file)
{
  std::string missing;
  if (image.format() == ImageFormat::kNifti)
    missing = image.field("qform_code") == "0" && image.field("sform_code") == "0" ? "qform or sform" : "";
  else if (image.format() == ImageFormat::kNrrd)
    missing = image.field("NRRD_space").empty() ? "space" : "";
  else
  {
    const std::map<std::string, std::string> fields = metaFields(file);
    const bool has_axes = fields.count("TransformMatrix") + fields.count("Orientation") + fields.count("Rotation") > 0;
    missing = fields.count("ElementSpacing") == 0 ? "ElementSpacing" : has_axes ? "" : "TransformMatrix";
  }
  if (!missing.empty())
    throw InputError(file, missing,
                     "is missing, so the position of the voxels in the patient is unknown; export the image with "
                     "spacing and orientation");
}

VolumeGrid gridOf(const ItkImage& image, const std::string& file)
{
  const std::vector<std::uint64_t> size = image.size();
  std::uint64_t others = 1;
  for (std::size_t axis = 3; axis < size.size(); ++axis)
    others *= size[axis];
  if (size.size() < 3 || others != 1)
    throw InputError(
        file, "",
        "has " + std::to_string(size.size()) + " dimensions; give one volume with three dimensions, no time series");
  VolumeGrid grid;
  for (unsigned axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = static_cast<int>(std::min<std::uint64_t>(size[axis], 1U << 30U));
    grid.spacing[axis] = kMillimetre * image.spacing(axis);
    grid.origin[axis] = kMillimetre * image.origin(axis);
    grid.axes.col(axis) = directionOf(image, axis);
  }
  requireValid(grid, file);
  return grid;
}

Volume readFile(const std::string& file, const ImportOptions& options)
{
  ItkImage image(file, {ImageFormat::kNifti, ImageFormat::kNrrd, ImageFormat::kMetaImage});
  requireOneComponent(image, file);
  requireOrientation(image, file);
  Volume volume;
  volume.grid = gridOf(image, file);
  const std::uint64_t voxels = volume.grid.voxels();
  requireMemory(voxels * (image.valueBytes() + sizeof(float) + sizeof(std::int16_t)), options, file);
  if (image.format() == ImageFormat::kMetaImage)
    requireCompleteMeta(file, voxels * image.valueBytes());
  if (image.format() == ImageFormat::kNifti)  // the type of the file, not that after scaling
    requireCompleteNifti(file, std::strtoull(image.field("vox_offset").c_str(), nullptr, 10),
                         voxels * std::strtoull(image.field("bitpix").c_str(), nullptr, 10) / 8);
  std::vector<float> values;
  values.reserve(voxels);
  image.read(values);
  if (options.modality.value_or(Modality::kCt) == Modality::kCt)
    requireHounsfieldUnits(values, 8 * image.valueBytes(), file);
  volume.modality = options.modality ? *options.modality : modalityOf(values, file);
  store(values, file, volume);
  return volume;
}

}  // namespace

Volume readImages(const std::string& path, const ImportOptions& options)
{
  std::error_code code;
  if (std::filesystem::is_directory(path, code))
    return readSeries(path, options);
  if (!std::filesystem::is_regular_file(path, code))
    throw InputError(path, "",
                     "is no file; give a folder with a DICOM series, or a file .nii, .nii.gz, .nrrd, .nhdr, .mha or "
                     ".mhd");
  return readFile(path, options);
}

}  // namespace endovascular_sim::image
