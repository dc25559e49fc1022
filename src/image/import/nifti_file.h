#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "image/volume_grid.h"

namespace endovascular_sim::image
{

/** NIfTI-1 file, also compressed by gzip. It is read without ITK, which replaces a sheared sform by the qform, values
 * that are not finite by zeros, and does not convert the offset to the unit of the spacing. */
class NiftiFile
{
public:
  /** First bytes of a NIfTI file: header and mark of its extensions. */
  static constexpr std::size_t kHeader = 352;

  /** @return true for a file that begins like a NIfTI-1 or NIfTI-2 file */
  static bool recognises(const std::string& file);

  /** Reads the header.
   *  @throws InputError for a pair of header and image, NIfTI-2, colours, several volumes, and an unusual type of
   * values */
  explicit NiftiFile(const std::string& file);

  /** Grid of the sform, or of the qform where the sform is not set.
   *  @throws InputError for a missing, sheared or implausible form, and for two forms that differ by more than half a
   * voxel */
  VolumeGrid grid() const;

  /** Appends all values, rescaled by slope and intercept of the header.
   *  @throws InputError for a file that holds fewer values than its header names */
  void read(std::vector<float>& values) const;

  unsigned valueBytes() const { return value_bytes_; }  ///< bytes of a value in the file

private:
  template <typename Number>
  Number field(std::size_t offset) const;
  double number(std::size_t offset) const { return static_cast<double>(field<float>(offset)); }
  double unit() const;
  Eigen::Matrix4d sform() const;
  Eigen::Matrix4d qform() const;
  VolumeGrid gridOf(const Eigen::Matrix4d& form, const char* name) const;
  void requireAgreement(const VolumeGrid& sform, const VolumeGrid& qform) const;
  std::uint64_t bytes() const;
  std::uint64_t offsetOfValues() const;

  std::string file_;
  std::string header_;
  bool is_swapped_ = false;  ///< the byte order is not that of this machine
  unsigned value_bytes_ = 0;
};

}  // namespace endovascular_sim::image
