#include "image/import/itk_image.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include "common/error.h"

namespace endovascular_sim::image
{
namespace
{

itk::ImageIOBase::Pointer ioOf(ImageFormat format)
{
  switch (format)
  {
    case ImageFormat::kDicom:
      return itk::GDCMImageIO::New().GetPointer();
    case ImageFormat::kNrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case ImageFormat::kMetaImage:
      break;
  }
  return itk::MetaImageIO::New().GetPointer();
}

/** Silences both libraries: their warnings can contain fields of the header. */
void silence()
{
  itk::Object::GlobalWarningDisplayOff();
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
}

InputError damaged(const std::string& file, const itk::ExceptionObject& error)
{
  return InputError(file, "", std::string("cannot be read: ") + error.GetDescription() + "; export the images again");
}

InputError unusualType(const std::string& file)
{
  return InputError(file, "",
                    "has values of an unusual type; store integers of 8, 16 or 32 bit, or floating point numbers");
}

template <typename Value>
void append(const std::vector<char>& buffer, std::vector<float>& values)
{
  const auto* first = reinterpret_cast<const Value*>(buffer.data());
  for (std::size_t i = 0; i < buffer.size() / sizeof(Value); ++i)
    values.push_back(static_cast<float>(first[i]));
}

}  // namespace

struct ItkImage::Io
{
  itk::ImageIOBase::Pointer io;
};

ItkImage::ItkImage(const std::string& file, const std::vector<ImageFormat>& formats)
  : file_(file), io_(std::make_unique<Io>())
{
  silence();
  try
  {
    for (const ImageFormat format : formats)
    {
      const itk::ImageIOBase::Pointer io = ioOf(format);
      if (!io->CanReadFile(file.c_str()))
        continue;
      io->SetFileName(file);
      io->ReadImageInformation();
      if (io->GetComponentType() == itk::IOComponentEnum::UNKNOWNCOMPONENTTYPE)
        throw unusualType(file);
      format_ = format;
      io_->io = io;
      return;
    }
  }
  catch (const itk::ExceptionObject& error)
  {
    throw damaged(file, error);
  }
  throw InputError(file, "",
                   "is no image that can be read; give a folder with a DICOM series, or a file .nii, .nii.gz, .nrrd, "
                   ".nhdr, .mha or .mhd");
}

ItkImage::~ItkImage() = default;
ItkImage::ItkImage(ItkImage&&) noexcept = default;
ItkImage& ItkImage::operator=(ItkImage&&) noexcept = default;

std::vector<std::uint64_t> ItkImage::size() const
{
  std::vector<std::uint64_t> size;
  for (unsigned axis = 0; axis < io_->io->GetNumberOfDimensions(); ++axis)
    size.push_back(io_->io->GetDimensions(axis));
  return size;
}

double ItkImage::spacing(unsigned axis) const
{
  return io_->io->GetSpacing(axis);
}

double ItkImage::origin(unsigned axis) const
{
  return io_->io->GetOrigin(axis);
}

std::vector<double> ItkImage::direction(unsigned axis) const
{
  return io_->io->GetDirection(axis);
}

unsigned ItkImage::components() const
{
  return io_->io->GetNumberOfComponents();
}

unsigned ItkImage::valueBytes() const
{
  return io_->io->GetComponentSize();
}

std::string ItkImage::field(const std::string& key) const
{
  std::string value;
  itk::ExposeMetaData<std::string>(io_->io->GetMetaDataDictionary(), key, value);
  const auto is_blank = [](unsigned char c) { return std::isspace(c) != 0 || c == 0; };
  value.erase(std::remove_if(value.begin(), value.end(), is_blank), value.end());
  return value;
}

void ItkImage::read(std::vector<float>& values)
{
  itk::ImageIOBase& io = *io_->io;
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis)
    region.SetSize(axis, io.GetDimensions(axis));
  io.SetIORegion(region);
  std::vector<char> buffer(static_cast<std::size_t>(io.GetImageSizeInBytes()));
  try
  {
    io.Read(buffer.data());
  }
  catch (const itk::ExceptionObject& error)
  {
    throw damaged(file_, error);
  }
  switch (io.GetComponentType())
  {
    case itk::IOComponentEnum::UCHAR:
      return append<unsigned char>(buffer, values);
    case itk::IOComponentEnum::CHAR:
      return append<signed char>(buffer, values);
    case itk::IOComponentEnum::USHORT:
      return append<unsigned short>(buffer, values);
    case itk::IOComponentEnum::SHORT:
      return append<short>(buffer, values);
    case itk::IOComponentEnum::UINT:
      return append<unsigned int>(buffer, values);
    case itk::IOComponentEnum::INT:
      return append<int>(buffer, values);
    case itk::IOComponentEnum::FLOAT:
      return append<float>(buffer, values);
    case itk::IOComponentEnum::DOUBLE:
      return append<double>(buffer, values);
    default:
      throw unusualType(file_);
  }
}

std::vector<std::vector<std::string>> dicomSeries(const std::string& folder)
{
  silence();
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetDirectory(folder);
  std::vector<std::vector<std::string>> series;
  for (const std::string& uid : names->GetSeriesUIDs())
    series.push_back(names->GetFileNames(uid));
  return series;
}

}  // namespace endovascular_sim::image
