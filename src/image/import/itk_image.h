#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace endovascular_sim::image
{

enum class ImageFormat
{
  kDicom,
  kNrrd,
  kMetaImage,
};

/** Image file that ITK reads. ITK brings an Eigen of its own, so its headers and ours meet in no source file. */
class ItkImage
{
public:
  /** Opens a file and reads its header.
   *  @throws InputError for a file in none of the formats, or a damaged one */
  ItkImage(const std::string& file, const std::vector<ImageFormat>& formats);
  ~ItkImage();
  ItkImage(ItkImage&&) noexcept;
  ItkImage& operator=(ItkImage&&) noexcept;

  ImageFormat format() const { return format_; }
  std::vector<std::uint64_t> size() const;             ///< along each dimension
  double spacing(unsigned axis) const;                 ///< [mm]
  double origin(unsigned axis) const;                  ///< LPS [mm]
  std::vector<double> direction(unsigned axis) const;  ///< unit vector, LPS
  unsigned components() const;                         ///< values per voxel
  unsigned valueBytes() const;                         ///< bytes of a value

  /** Field of the header, without blanks; empty if there is none. */
  std::string field(const std::string& key) const;

  /** Reads all values and appends them, rescaled where the file has a slope and an intercept.
   *  @throws InputError for a damaged file and an unusual type of values */
  void read(std::vector<float>& values);

private:
  struct Io;
  std::string file_;
  ImageFormat format_ = ImageFormat::kDicom;
  std::unique_ptr<Io> io_;
};

/** Files of the DICOM series of a folder, one list per series. */
std::vector<std::vector<std::string>> dicomSeries(const std::string& folder);

}  // namespace endovascular_sim::image
