#include "image/import/nifti_file.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "common/error.h"
#include "common/text/format.h"
#include "common/units.h"
#include "image/import/complete_file.h"

namespace endovascular_sim::image
{
namespace
{

// Offsets of fields in the header (nifti1.h)
constexpr std::size_t kDimensions = 40;
constexpr std::size_t kType = 70;
constexpr std::size_t kSpacings = 76;
constexpr std::size_t kOffsetOfValues = 108;
constexpr std::size_t kSlope = 112;
constexpr std::size_t kIntercept = 116;
constexpr std::size_t kUnits = 123;
constexpr std::size_t kQformCode = 252;
constexpr std::size_t kSformCode = 254;
constexpr std::size_t kQuaternion = 256;
constexpr std::size_t kQformOffset = 268;
constexpr std::size_t kSformRows = 280;
constexpr std::size_t kMagic = 344;

constexpr double kSheared = 1e-3;        // scalar product of two axes
constexpr double kMostHeader = 1e8;      // bytes before the values
constexpr std::size_t kChunk = 1 << 20;  // values

struct CloseGzip
{
  void operator()(gzFile file) const { gzclose(file); }
};
using Gzip = std::unique_ptr<gzFile_s, CloseGzip>;

/** First bytes of a file; shorter where the file is. gzip reads files that are not compressed as they are. */
std::string beginOf(const std::string& file)
{
  std::string content(NiftiFile::kHeader, '\0');
  const Gzip in(gzopen(file.c_str(), "rb"));
  const int count = in ? gzread(in.get(), content.data(), static_cast<unsigned>(content.size())) : 0;
  content.resize(static_cast<std::size_t>(std::max(count, 0)));
  return content;
}

std::int32_t sizeOfHeader(const std::string& content, bool is_swapped)
{
  std::string bytes = content.substr(0, 4);
  if (is_swapped)
    std::reverse(bytes.begin(), bytes.end());
  std::int32_t size = 0;
  std::memcpy(&size, bytes.data(), std::min(bytes.size(), sizeof size));
  return size;
}

bool isNifti2(const std::string& content)
{
  return content.size() > 8 && (content.compare(4, 3, "n+2") == 0 || content.compare(4, 3, "ni2") == 0);
}

bool isNifti1(const std::string& content)
{
  if (content.size() < kMagic + 4 || content.compare(kMagic, 1, "n") != 0 || content.compare(kMagic + 2, 1, "1") != 0)
    return false;
  return sizeOfHeader(content, false) == 348 || sizeOfHeader(content, true) == 348;
}

/** Bytes of a value of a type of the header; 0 for an unknown type. */
unsigned bytesOf(int type)
{
  switch (type)
  {
    case 2:    // unsigned, 8 bit
    case 256:  // signed, 8 bit
      return 1;
    case 4:    // signed, 16 bit
    case 512:  // unsigned, 16 bit
      return 2;
    case 8:    // signed, 32 bit
    case 768:  // unsigned, 32 bit
    case 16:   // floating point
      return 4;
    case 64:    // floating point
    case 1024:  // signed, 64 bit
    case 1280:  // unsigned, 64 bit
      return 8;
    default:
      return 0;
  }
}

/** Values per voxel of types that hold several; 1 for the others. */
int componentsOf(int type)
{
  switch (type)
  {
    case 128:  // colours
      return 3;
    case 2304:  // colours with opacity
      return 4;
    case 32:  // complex
    case 1792:
    case 2048:
      return 2;
    default:
      return 1;
  }
}

template <typename Value>
void append(const char* bytes, std::size_t count, double slope, double intercept, std::vector<float>& values)
{
  for (std::size_t k = 0; k < count; ++k)
  {
    Value value;
    std::memcpy(&value, bytes + k * sizeof value, sizeof value);
    values.push_back(static_cast<float>(slope * static_cast<double>(value) + intercept));
  }
}

void append(int type, const char* bytes, std::size_t count, double slope, double intercept, std::vector<float>& values)
{
  switch (type)
  {
    case 2:
      return append<std::uint8_t>(bytes, count, slope, intercept, values);
    case 256:
      return append<std::int8_t>(bytes, count, slope, intercept, values);
    case 4:
      return append<std::int16_t>(bytes, count, slope, intercept, values);
    case 512:
      return append<std::uint16_t>(bytes, count, slope, intercept, values);
    case 8:
      return append<std::int32_t>(bytes, count, slope, intercept, values);
    case 768:
      return append<std::uint32_t>(bytes, count, slope, intercept, values);
    case 16:
      return append<float>(bytes, count, slope, intercept, values);
    case 64:
      return append<double>(bytes, count, slope, intercept, values);
    case 1024:
      return append<std::int64_t>(bytes, count, slope, intercept, values);
    default:
      return append<std::uint64_t>(bytes, count, slope, intercept, values);
  }
}

}  // namespace

bool NiftiFile::recognises(const std::string& file)
{
  const std::string content = beginOf(file);
  return isNifti1(content) || isNifti2(content);
}

NiftiFile::NiftiFile(const std::string& file) : file_(file), header_(beginOf(file))
{
  if (isNifti2(header_))
    throw InputError(file, "", "is NIfTI-2, which is not read; convert it to NIfTI-1 (.nii or .nii.gz)");
  if (!isNifti1(header_) || header_.size() < kHeader || header_[kMagic + 1] != '+')
    throw InputError(file, "", "is a NIfTI header without the values; give one file .nii or .nii.gz");
  is_swapped_ = sizeOfHeader(header_, false) != 348;
  const int type = field<std::int16_t>(kType);
  const int dimensions = field<std::int16_t>(kDimensions);
  int components = componentsOf(type);
  for (int axis = 4; axis <= std::min(dimensions, 7); ++axis)
  {
    const int size = field<std::int16_t>(kDimensions + 2 * static_cast<std::size_t>(axis));
    if (axis == 5 && size > 1)
      components = size;
    else if (size > 1)
      throw InputError(file, "",
                       "has " + std::to_string(dimensions) +
                           " dimensions; give one volume with three dimensions, i.e. one phase of a time series");
  }
  if (components != 1)
    throw InputError(
        file, "",
        "has " + std::to_string(components) + " values per voxel; give an image with one, no colours or vectors");
  if (dimensions < 3 || dimensions > 7)
    throw InputError(file, "", "has " + std::to_string(dimensions) + " dimensions; give one volume with three");
  value_bytes_ = bytesOf(type);
  if (value_bytes_ == 0)
    throw InputError(file, "", "has values of an unusual type; store integers or floating point numbers");
}

template <typename Number>
Number NiftiFile::field(std::size_t offset) const
{
  std::string bytes = header_.substr(offset, sizeof(Number));
  if (is_swapped_)
    std::reverse(bytes.begin(), bytes.end());
  Number value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

double NiftiFile::unit() const
{
  switch (static_cast<unsigned char>(header_[kUnits]) & 7U)
  {
    case 1:
      return 1.0;
    case 3:
      return 1e-6;
    case 0:  // not stated; millimetres are usual
    case 2:
      return 1e-3;
    default:
      throw InputError(file_, "xyzt_units", "is no unit of length; export the image in millimetres");
  }
}

Eigen::Matrix4d NiftiFile::sform() const
{
  Eigen::Matrix4d form = Eigen::Matrix4d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      form(row, column) = number(kSformRows + static_cast<std::size_t>(16 * row + 4 * column));
  return form;
}

Eigen::Matrix4d NiftiFile::qform() const
{
  const Eigen::Vector3d imaginary(number(kQuaternion), number(kQuaternion + 4), number(kQuaternion + 8));
  const double rest = 1.0 - imaginary.squaredNorm();
  Eigen::Quaterniond turn(std::sqrt(std::max(rest, 0.0)), imaginary.x(), imaginary.y(), imaginary.z());
  turn.normalize();  // 32 bit
  Eigen::Vector3d spacing(number(kSpacings + 4), number(kSpacings + 8), number(kSpacings + 12));
  if (number(kSpacings) < 0.0)
    spacing.z() *= -1.0;
  Eigen::Matrix4d form = Eigen::Matrix4d::Identity();
  form.topLeftCorner<3, 3>() = turn.toRotationMatrix() * spacing.asDiagonal();
  for (int row = 0; row < 3; ++row)
    form(row, 3) = number(kQformOffset + 4 * static_cast<std::size_t>(row));
  return form;
}

VolumeGrid NiftiFile::gridOf(const Eigen::Matrix4d& form, const char* name) const
{
  VolumeGrid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Eigen::Vector3d step(-form(0, axis), -form(1, axis), form(2, axis));  // RAS to LPS
    grid.size[axis] = field<std::int16_t>(kDimensions + 2 * static_cast<std::size_t>(axis + 1));
    grid.spacing[axis] = unit() * step.norm();
    grid.axes.col(axis) = step.normalized();
  }
  grid.origin = unit() * Eigen::Vector3d(-form(0, 3), -form(1, 3), form(2, 3));
  double shear = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    shear = std::max(shear, std::abs(grid.axes.col(axis).dot(grid.axes.col((axis + 1) % 3))));
  if (shear > kSheared)
    throw InputError(file_, name,
                     "its axes are not orthogonal: a gantry tilt or shear of " +
                         formatted("%.2f", std::asin(std::min(shear, 1.0)) / units::kDegree) +
                         "°; resample the image to a straight grid first");
  requireValid(grid, file_);
  return grid;
}

void NiftiFile::requireAgreement(const VolumeGrid& sform, const VolumeGrid& qform) const
{
  double farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Array3d upper((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
    const Eigen::Vector3d index = upper * (sform.size.array() - 1).cast<double>();
    farthest = std::max(farthest, (sform.position(index) - qform.position(index)).norm());
  }
  if (farthest > 0.5 * sform.spacing.minCoeff())
    throw InputError(
        file_, "qform and sform",
        "place a corner of the image " + formatted("%.1f", 1e3 * farthest) +
            " mm apart, so its position in the patient is unknown; set the code of the wrong form to 0, or "
            "export the image again");
}

VolumeGrid NiftiFile::grid() const
{
  const bool has_sform = field<std::int16_t>(kSformCode) > 0;
  const bool has_qform = field<std::int16_t>(kQformCode) > 0;
  if (!has_sform && !has_qform)
    throw InputError(file_, "qform or sform",
                     "is missing, so the position of the voxels in the patient is unknown; export the image with "
                     "spacing and orientation");
  if (!has_sform)
    return gridOf(qform(), "qform");
  VolumeGrid grid = gridOf(sform(), "sform");
  if (has_qform)
    requireAgreement(grid, gridOf(qform(), "qform"));
  return grid;
}

std::uint64_t NiftiFile::bytes() const
{
  std::uint64_t bytes = value_bytes_;
  for (std::size_t axis = 1; axis <= 3; ++axis)
    bytes *= static_cast<std::uint64_t>(std::max<std::int16_t>(field<std::int16_t>(kDimensions + 2 * axis), 0));
  return bytes;
}

std::uint64_t NiftiFile::offsetOfValues() const
{
  const double offset = number(kOffsetOfValues);
  if (!(offset >= static_cast<double>(kHeader) && offset <= kMostHeader))
    throw InputError(file_, "vox_offset",
                     "is " + formatted("%g", offset) + "; must be 352 or more; export the image again");
  return static_cast<std::uint64_t>(offset);
}

void NiftiFile::read(std::vector<float>& values) const
{
  constexpr std::uint64_t kMostCompression = 1032;  // of gzip
  std::error_code code;
  const std::uint64_t length = std::filesystem::file_size(file_, code);
  if (code || kMostCompression * length < bytes())
    throw incompleteFile(file_);
  const int type = field<std::int16_t>(kType);
  double slope = number(kSlope);
  double intercept = number(kIntercept);
  if (slope == 0.0 || !std::isfinite(slope))  // no scaling, by the standard
  {
    slope = 1.0;
    intercept = 0.0;
  }
  const Gzip in(gzopen(file_.c_str(), "rb"));
  if (!in || gzseek(in.get(), static_cast<z_off_t>(offsetOfValues()), SEEK_SET) < 0)
    throw incompleteFile(file_);
  values.reserve(values.size() + bytes() / value_bytes_);
  std::vector<char> buffer(kChunk * value_bytes_);
  for (std::uint64_t left = bytes(); left > 0;)
  {
    const auto wanted = static_cast<unsigned>(std::min<std::uint64_t>(left, buffer.size()));
    if (gzread(in.get(), buffer.data(), wanted) != static_cast<int>(wanted))
      throw incompleteFile(file_);
    if (is_swapped_)
      for (unsigned k = 0; k < wanted; k += value_bytes_)
        std::reverse(buffer.begin() + k, buffer.begin() + k + value_bytes_);
    append(type, buffer.data(), wanted / value_bytes_, slope, intercept, values);
    left -= wanted;
  }
  char next = 0;
  int error = Z_OK;
  const int more = gzread(in.get(), &next, 1);  // compares the check sum where the file ends here
  gzerror(in.get(), &error);
  if (more < 0 || error != Z_OK)
    throw incompleteFile(file_);
}

}  // namespace endovascular_sim::image
