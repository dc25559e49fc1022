#include "segmentation/view/ct_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "segmentation/lumen/contrast.h"
#include "segmentation/view/ct_page_lumen.h"
#include "segmentation/view/ct_page_script.h"
#include "segmentation/view/straightened_view.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kWindowBegin = -200.0;                               ///< of a CT [HU]
constexpr double kGreyStep = (kMostContrast - kWindowBegin) / 255.0;  ///< [HU]
constexpr std::size_t kMostVoxels = 17000000;                         // 23 MB in base 64

/** Voxels that are averaged along each axis: the finest axis first. */
Eigen::Vector3i reductionOf(const Scan& scan)
{
  Eigen::Vector3i factor = Eigen::Vector3i::Ones();
  const auto voxels = [&]
  {
    const Eigen::Vector3i size = scan.size().array() / factor.array();
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z());
  };
  while (voxels() > kMostVoxels)
  {
    int finest = 2;
    for (int axis = 1; axis >= 0; --axis)
      if (factor[axis] * scan.spacing()[axis] < factor[finest] * scan.spacing()[finest] * (1.0 - 1e-9))
        finest = axis;
    ++factor[finest];
  }
  return factor;
}

/** Window of an image of unknown unit: up to the value that one voxel in a thousand exceeds. */
GreyWindow windowOf(const Scan& scan)
{
  if (scan.modality() == image::Modality::kCt)
    return {kWindowBegin, kMostContrast};
  std::vector<std::int16_t> values;
  const std::vector<std::int16_t>& stored = scan.volume().stored;
  for (std::size_t k = 0; k < stored.size(); k += 37)
    values.push_back(stored[k]);
  const auto high = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 999 / 1000);
  std::nth_element(values.begin(), high, values.end());
  return {0.0, std::max(1.0, scan.volume().scale * *high)};
}

std::string reducedBytes(const Scan& scan, const Eigen::Vector3i& factor, const GreyWindow& window)
{
  const Eigen::Vector3i size = scan.size().array() / factor.array();
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(size.prod()));
  const double cells = factor.prod();
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
      {
        double sum = 0.0;
        for (int c = 0; c < factor.z(); ++c)
          for (int b = 0; b < factor.y(); ++b)
            for (int a = 0; a < factor.x(); ++a)
              sum += scan.value(factor.x() * i + a, factor.y() * j + b, factor.z() * k + c);
        bytes.push_back(static_cast<char>(window.grey(sum / cells)));
      }
  return bytes;
}

/** Limits by which the page judges clicks, those of checkClicks(). */
nlohmann::ordered_json contrastLimits()
{
  nlohmann::ordered_json tissues;
  tissues.push_back({{"below", kFat}, {"name", "fat, air or lung"}});  // the window begins above air
  tissues.push_back({{"below", kLeastContrast}, {"name", tissueName(kSoftTissue)}});
  // The window of the page ends at the most contrast.
  return {{"soft", kSoftTissue}, {"most", kMostContrast - kGreyStep},     {"onWall", kOnWall}, {"inLumen", kInLumen},
          {"tissues", tissues},  {"brightest", tissueName(kMostContrast)}};
}

}  // namespace

std::string base64(const std::string& bytes)
{
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3)
  {
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8U | (k + b < bytes.size() ? static_cast<unsigned char>(bytes[k + b]) : 0U);
    for (std::size_t d = 0; d < 4; ++d)
      text += k + d > bytes.size() ? '=' : kDigits[group >> (18U - 6U * static_cast<unsigned>(d)) & 63U];
  }
  return text;
}

std::string ctPage(const Scan& scan)
{
  const Eigen::Vector3i factor = reductionOf(scan);
  const GreyWindow window = windowOf(scan);
  const Eigen::Vector3i size = scan.size().array() / factor.array();
  const Eigen::Vector3d spacing = scan.spacing().cwiseProduct(factor.cast<double>());
  const Eigen::Vector3d first = 0.5 * (spacing - scan.spacing());  // centre of the first group of voxels
  const Eigen::Vector3d origin = scan.toPatient(first);
  const Eigen::Matrix3d& axes = scan.volume().grid.axes;
  nlohmann::ordered_json grid;
  for (int k = 0; k < 3; ++k)
  {
    grid["size"].push_back(size[k]);
    grid["spacing"].push_back(1e3 * spacing[k]);
    grid["origin"].push_back(1e3 * origin[k]);
    grid["axes"].push_back({axes(0, k), axes(1, k), axes(2, k)});
  }
  grid["window"] = {window.black, window.white};
  grid["unit"] = scan.modality() == image::Modality::kCt ? " HU" : "";
  grid["contrast"] = contrastLimits();
  return std::string(kPageBegin) + "const grid = " + grid.dump() + ";\nconst data = \"" +
         base64(reducedBytes(scan, factor, window)) + "\";\n" + kPageImage + kPageLumen + kPageEnd;
}

}  // namespace endovascular_sim::segmentation
