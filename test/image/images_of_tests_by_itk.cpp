// Writes a volume of synthetic_ct by ITK: FOLDER/series (DICOM) and FOLDER/image.nii.gz.
// usage: images_of_tests_by_itk VOLUME.vol FOLDER

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <itkGDCMImageIO.h>
#include <itkImage.h>
#include <itkImageFileWriter.h>
#include <itkMetaDataObject.h>
#include <itkNiftiImageIO.h>

namespace
{

using Image = itk::Image<short, 3>;

/** Offsets of the fields of a volume file (image/volume_file.h) [bytes]. */
constexpr std::size_t kSizes = 8;
constexpr std::size_t kNumbers = 24;
constexpr std::size_t kValues = 160;

std::vector<char> contentOf(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/** Image of the slices from `begin` to `end` of a volume. */
Image::Pointer imageOf(const std::vector<char>& content, int begin, int end)
{
  std::array<std::int32_t, 3> sizes{};
  std::array<double, 15> numbers{};  // spacing, origin, axes by columns [m]
  std::memcpy(sizes.data(), &content.at(kSizes), sizeof sizes);
  std::memcpy(numbers.data(), &content.at(kNumbers), sizeof numbers);
  const auto size = [&sizes](int axis) { return static_cast<std::size_t>(sizes.at(static_cast<std::size_t>(axis))); };
  if (end < 0)
    end = sizes[2];
  Image::RegionType region;
  region.SetSize({size(0), size(1), static_cast<std::size_t>(end - begin)});
  Image::SpacingType spacing;
  Image::PointType origin;
  Image::DirectionType direction;
  for (unsigned row = 0; row < 3; ++row)
  {
    spacing[row] = 1e3 * numbers.at(row);
    origin[row] = 1e3 * (numbers.at(3 + row) + begin * numbers[2] * numbers.at(12 + row));
    for (unsigned column = 0; column < 3; ++column)
      direction(row, column) = numbers.at(6 + 3 * column + row);
  }
  const auto image = Image::New();
  image->SetRegions(region);
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  image->SetDirection(direction);
  image->Allocate();
  const std::size_t slice = size(0) * size(1) * sizeof(short);
  const std::size_t bytes = slice * static_cast<std::size_t>(end - begin);
  const std::size_t offset = kValues + slice * static_cast<std::size_t>(begin);
  if (content.size() < offset + bytes)
    throw std::runtime_error("the volume is truncated");
  std::memcpy(image->GetBufferPointer(), &content[offset], bytes);
  return image;
}

void write(const Image::Pointer& image, itk::ImageIOBase* io, const std::string& file)
{
  const auto writer = itk::ImageFileWriter<Image>::New();
  writer->SetImageIO(io);
  writer->SetInput(image);
  writer->SetFileName(file);
  writer->SetUseInputMetaDataDictionary(true);
  writer->Update();
}

void writeSeries(const std::vector<char>& content, const std::string& folder)
{
  std::filesystem::create_directories(folder);
  std::int32_t slices = 0;
  std::memcpy(&slices, &content.at(kSizes + 8), sizeof slices);
  for (int k = 0; k < slices; ++k)
  {
    const Image::Pointer image = imageOf(content, k, k + 1);
    const std::string number = std::to_string(k + 1);
    const std::vector<std::pair<std::string, std::string>> fields = {{"0008|0060", "CT"},
                                                                     {"0008|0018", "1.2.826.0.1.7." + number},
                                                                     {"0010|0010", "Doe^Jane"},
                                                                     {"0010|0020", "ID4711"},
                                                                     {"0010|0030", "19620314"},
                                                                     {"0020|000d", "1.2.826.0.1"},
                                                                     {"0020|000e", "1.2.826.0.1.7"},
                                                                     {"0020|0013", number},
                                                                     {"0028|1052", "0"},
                                                                     {"0028|1053", "1"}};
    for (const auto& [key, value] : fields)
      itk::EncapsulateMetaData<std::string>(image->GetMetaDataDictionary(), key, value);
    const auto io = itk::GDCMImageIO::New();
    io->KeepOriginalUIDOn();
    write(image, io, folder + "/" + number + ".dcm");
  }
}

}  // namespace

int main(int argc, char** argv)
{
  if (argc != 3)
  {
    std::fputs("usage: images_of_tests_by_itk VOLUME.vol FOLDER\n", stderr);
    return 2;
  }
  try
  {
    const std::vector<char> content = contentOf(argv[1]);
    const std::string folder = argv[2];
    writeSeries(content, folder + "/series");
    const Image::Pointer image = imageOf(content, 0, -1);
    write(image, itk::NiftiImageIO::New(), folder + "/image.nii.gz");
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "images_of_tests_by_itk: %s\n", error.what());
    return 1;
  }
}
