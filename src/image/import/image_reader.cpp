#include "image/import/image_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/units.h"
#include "image/import/complete_file.h"
#include "image/import/image_values.h"
#include "image/import/itk_image.h"
#include "image/import/label_values.h"
#include "image/import/meta_header.h"
#include "image/import/nifti_file.h"
#include "image/slice_stack.h"

namespace endovascular_sim::image
{
namespace
{

using units::kMillimetre;

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

/** @return true for a file that begins like a DICOM file */
bool isDicom(const std::filesystem::path& file)
{
  std::string begin(132, '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(begin.data(), static_cast<long>(begin.size())) && begin.compare(128, 4, "DICM") == 0;
}

/** Folders below a folder that hold DICOM images: discs have one per series. The search ends after a bounded number of
 * files. */
std::set<std::string> foldersWithImages(const std::string& folder)
{
  constexpr int kMostFiles = 20000;
  constexpr int kDeepest = 8;
  std::set<std::string> folders;
  std::error_code code;
  const auto options = std::filesystem::directory_options::skip_permission_denied;
  int files = 0;
  for (std::filesystem::recursive_directory_iterator entry(folder, options, code), end;
       !code && entry != end && files < kMostFiles; entry.increment(code), ++files)
  {
    if (entry.depth() >= kDeepest)
      entry.disable_recursion_pending();
    const std::string parent = entry->path().parent_path().string();
    if (entry.depth() > 0 && folders.count(parent) == 0 && entry->is_regular_file(code) && isDicom(entry->path()))
      folders.insert(parent);
  }
  return folders;
}

/** @throws InputError that names folders with images below a folder without */
void requireNoSeriesBelow(const std::string& folder)
{
  constexpr std::size_t kNamed = 3;
  const std::set<std::string> folders = foldersWithImages(folder);
  if (folders.empty())
    return;
  std::string list;
  std::size_t number = 0;
  for (const std::string& below : folders)
    if (number++ < kNamed)
      list += (list.empty() ? "" : ", ") + below;
  if (folders.size() > kNamed)
    list += " and " + std::to_string(folders.size() - kNamed) + " more";
  throw InputError(folder, "", "holds no DICOM images itself, but folders below do; give one of them: " + list);
}

/** Files of the wanted series of a folder. */
std::vector<std::string> seriesOf(const std::string& folder, const ImportOptions& options)
{
  std::vector<std::vector<std::string>> series = dicomSeries(folder);
  if (series.empty())
    requireNoSeriesBelow(folder);
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

/** Numbers of a field of a DICOM file, which are divided by backslashes. ITK replaces those that are implausible by
 * defaults.
 *  @throws InputError for a missing field and another number of finite numbers */
std::vector<double> numbersOf(const ItkImage& image, const char* key, const char* name, std::size_t count,
                              const std::string& file)
{
  const std::string field = image.field(key);
  if (field.empty())
    throw InputError(file, name, "is missing; export the series with spacing, position and orientation");
  std::vector<double> numbers;
  std::istringstream words(field);
  for (std::string word; std::getline(words, word, '\\');)
  {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (word.empty() || *end != '\0' || !std::isfinite(numbers.back()))
      numbers.clear();
  }
  if (numbers.size() != count)
    throw InputError(file, name,
                     "is '" + field + "'; must have " + std::to_string(count) + " numbers; export the series again");
  return numbers;
}

/** Unit vectors of rows and columns. @throws InputError for others */
void readOrientation(const std::vector<double>& numbers, Slice& slice)
{
  constexpr double kUnit = 1e-3;  // error of length and scalar product
  slice.along_row = {numbers[0], numbers[1], numbers[2]};
  slice.along_column = {numbers[3], numbers[4], numbers[5]};
  if (!(std::abs(slice.along_row.norm() - 1.0) <= kUnit && std::abs(slice.along_column.norm() - 1.0) <= kUnit &&
        std::abs(slice.along_row.dot(slice.along_column)) <= kUnit))
    throw InputError(slice.file, "ImageOrientationPatient",
                     "is no pair of perpendicular unit vectors; export the series again");
}

/** Number of frames of a DICOM file. */
int framesOf(const ItkImage& image)
{
  return std::max(1, std::atoi(image.field("0028|0008").c_str()));
}

/** Geometry of a slice. @throws InputError where the file has no spacing, position or orientation */
Slice sliceOf(const ItkImage& image, const std::string& file)
{
  requireOneComponent(image, file);
  const std::vector<std::uint64_t> size = image.size();
  if (framesOf(image) > 1 || (size.size() > 2 && size[2] > 1))
    throw InputError(file, "",
                     "is one file with " + std::to_string(framesOf(image)) +
                         " frames (enhanced CT or MR), which is not read; convert it to NIfTI, e.g. by dcm2niix");
  Slice slice;
  slice.file = file;
  slice.size = {static_cast<int>(size.at(0)), static_cast<int>(size.at(1))};
  const std::vector<double> spacing = numbersOf(image, "0028|0030", "PixelSpacing", 2, file);
  if (!(spacing[0] > 0.0 && spacing[1] > 0.0))
    throw InputError(file, "PixelSpacing", "must be greater than 0; export the series with its spacing");
  slice.spacing = kMillimetre * Eigen::Vector2d(spacing[1], spacing[0]);  // the field begins with that of the rows
  const std::vector<double> origin = numbersOf(image, "0020|0032", "ImagePositionPatient", 3, file);
  slice.origin = kMillimetre * Eigen::Vector3d(origin[0], origin[1], origin[2]);
  readOrientation(numbersOf(image, "0020|0037", "ImageOrientationPatient", 6, file), slice);
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

/** Subtracts the user's number from all values. */
void subtract(double number, std::vector<float>& values)
{
  if (number != 0.0)
    for (float& value : values)
      value = static_cast<float>(value - number);
}

/** Modality that the user or a file names. */
std::optional<Modality> modalityOf(const std::string& field, const ImportOptions& options)
{
  return options.modality.value_or(field == "CT" ? Modality::kCt : Modality::kOther);
}

/** Stores the values of an image, or the chosen labels of a label map. */
void store(const ImageValues& read, const std::optional<Modality>& modality, const ImportOptions& options,
           const std::string& path, Volume& volume)
{
  if (options.labels.empty())
    storeValues(read, modality, path, volume);
  else
    storeLabels(read, options.labels, path, volume);
}

Volume readSeries(const std::string& folder, const ImportOptions& options)
{
  std::vector<Slice> slices;
  std::string modality;
  ImageValues read;
  for (const std::string& file : seriesOf(folder, options))
  {
    const ItkImage image(file, {ImageFormat::kDicom});
    slices.push_back(sliceOf(image, file));
    modality = image.field("0008|0060");
    read.bits = image.field("0028|0100") == "8" ? 8 : 16;
    if (modality == "CT" && !options.modality)
      requireRescaling(image, file);
  }
  const SliceStack stack = stackSlices(std::move(slices), folder);
  Volume volume;
  volume.grid = stack.grid;
  read.columns = volume.grid.size.x();
  const std::uint64_t voxels = volume.grid.voxels();
  requireMemory(voxels * (sizeof(float) + sizeof(std::int16_t)), options, folder);
  read.values.reserve(voxels);
  for (const std::string& file : stack.files)
    requireCompleteDicom(file);
  for (const std::string& file : stack.files)
    ItkImage(file, {ImageFormat::kDicom}).read(read.values);
  if (read.values.size() != voxels)
    throw InputError(folder, "", "its slices hold other numbers of pixels than their headers; export the series again");
  subtract(options.subtract, read.values);
  store(read, modalityOf(modality, options), options, folder, volume);
  return volume;
}

/** Checks that a file has spacing and orientation, which ITK would replace by defaults.
 *  @throws InputError with the missing field */
void requireOrientation(const ItkImage& image, const std::string& file)
{
  std::string missing;
  if (image.format() == ImageFormat::kNrrd)
    missing = image.field("NRRD_space").empty() ? "space" : "";
  else
  {
    const MetaHeader header(file);
    const bool has_axes = header.has("TransformMatrix") || header.has("Orientation") || header.has("Rotation");
    missing = !header.has("ElementSpacing") ? "ElementSpacing" : has_axes ? "" : "TransformMatrix";
  }
  if (!missing.empty())
    throw InputError(file, missing,
                     "is missing, so the position of the voxels in the patient is unknown; export the image with "
                     "spacing and orientation");
}

/** Checks the unit of lengths in an NRRD file, which ITK ignores. @throws InputError for another one than millimetres
 */
void requireMillimetres(const std::string& file)
{
  constexpr int kMostLines = 1000;
  const std::string key = "space units:";
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int k = 0; k < kMostLines && std::getline(in, line) && !line.empty() && line != "\r"; ++k)
  {
    if (line.compare(0, key.size(), key) != 0)
      continue;
    std::istringstream units(line.substr(key.size()));
    for (std::string unit; units >> unit;)
      if (unit != "\"mm\"" && unit != "\"\"")
        throw InputError(file, "space units", "are " + unit + "; export the image in millimetres");
  }
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

/** Reads NRRD and MetaImage. */
void readByItk(const std::string& file, const ImportOptions& options, Volume& volume, ImageValues& read)
{
  MetaHeader(file).requireReadable();
  ItkImage image(file, {ImageFormat::kNrrd, ImageFormat::kMetaImage});
  requireOneComponent(image, file);
  requireOrientation(image, file);
  if (image.format() == ImageFormat::kNrrd)
    requireMillimetres(file);
  volume.grid = gridOf(image, file);
  const std::uint64_t voxels = volume.grid.voxels();
  requireMemory(voxels * (image.valueBytes() + sizeof(float) + sizeof(std::int16_t)), options, file);
  if (image.format() == ImageFormat::kMetaImage)
    MetaHeader(file).requireComplete(voxels, image.valueBytes(), static_cast<std::size_t>(volume.grid.size.z()));
  read.bits = 8 * image.valueBytes();
  read.values.reserve(voxels);
  image.read(read.values);
}

void readNifti(const std::string& file, const ImportOptions& options, Volume& volume, ImageValues& read)
{
  const NiftiFile image(file);
  volume.grid = image.grid();
  requireMemory(volume.grid.voxels() * (sizeof(float) + sizeof(std::int16_t)), options, file);
  read.bits = 8 * image.valueBytes();
  image.read(read.values);
}

/** @throws InputError for a file of DICOM: a series is a folder */
void requireNoDicom(const std::string& file)
{
  if (!isDicom(file))
    return;
  const ItkImage image(file, {ImageFormat::kDicom});
  sliceOf(image, file);
  throw InputError(
      file, "",
      "is one slice of a DICOM series; give its folder " + std::filesystem::absolute(file).parent_path().string());
}

Volume readFile(const std::string& file, const ImportOptions& options)
{
  Volume volume;
  ImageValues read;
  requireNoDicom(file);
  if (NiftiFile::recognises(file))
    readNifti(file, options, volume, read);
  else
    readByItk(file, options, volume, read);
  read.columns = volume.grid.size.x();
  subtract(options.subtract, read.values);
  store(read, options.modality, options, file, volume);
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
