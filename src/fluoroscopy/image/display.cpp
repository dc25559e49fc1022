#include "fluoroscopy/image/display.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/fast_math.h"
#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr float kBlack = -1.35F;           // d of grey value 0
constexpr float kWhite = 0.85F;            // d of grey value 255
constexpr float kBlackDifference = -0.6F;  // s of grey value 0
constexpr float kWhiteDifference = 0.2F;   // s of grey value 255
constexpr double kCompression = 0.32;      // slope of the local mean
constexpr double kSaturation = 0.55;       // largest contribution of the local mean
constexpr double kLocal = 0.02;            // standard deviation of the local mean [m]
constexpr float kSmallestCount = 0.5F;
constexpr double kLargestCount = 65535.0;  // saturation of the detector
constexpr float kShutter = 20.0F;          // change of d behind the blades: black in any surroundings

void requireRange(const char* key, double value, double low, double high)
{
  if (!(value >= low && value <= high))
    throw InputError("X-ray display", key, "must lie between " + std::to_string(low) + " and " + std::to_string(high));
}

/** d of one row; @p shift is the difference s·tanh(c b/s) − b per pixel. */
EVS_WIDE_VECTORS void logarithm(const std::uint16_t* raw, const float* shift, float log_reference, float* detail,
                                int count)
{
  for (int i = 0; i < count; ++i)
  {
    const auto value = static_cast<float>(static_cast<std::int32_t>(raw[i]));
    detail[i] = fastLog(value > kSmallestCount ? value : kSmallestCount) - log_reference + shift[i];
  }
}

/** Grey values of one row with edge enhancement. @p above and @p below are the neighbouring rows. */
EVS_WIDE_VECTORS void window(const float* above, const float* row, const float* below, float edge, float sign,
                             std::uint8_t* image, int count)
{
  constexpr float kScale = 255.0F / (kWhite - kBlack);
  const float offset = sign > 0.0F ? 0.5F : 255.5F;
  for (int i = 0; i < count; ++i)
  {
    const float sides = row[i - 1] + row[i + 1] + above[i] + below[i];
    const float corners = above[i - 1] + above[i + 1] + below[i - 1] + below[i + 1];
    const float value = row[i] + edge * (row[i] - (row[i] + sides + corners) * (1.0F / 9.0F));
    float grey = (value - kBlack) * kScale;
    grey = grey > 0.0F ? grey : 0.0F;
    grey = grey < 255.0F ? grey : 255.0F;
    image[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(sign * grey + offset));
  }
}

EVS_WIDE_VECTORS void mixFrames(float weight, float* previous, float* detail, std::size_t count)
{
  for (std::size_t i = 0; i < count; ++i)
    previous[i] = detail[i] = detail[i] + weight * (previous[i] - detail[i]);
}

}  // namespace

Display::Display(const DisplaySettings& settings) : settings_(settings)
{
  requireRange("edge_enhancement", settings.edge_enhancement, 0.0, 4.0);
  requireRange("zoom", settings.zoom, 1.0, 8.0);
  requireRange("recursive_filter", settings.recursive_filter, 0.0, 0.95);
}

/** Fills detail_, an image with a margin of one pixel. */
void Display::compress(int pixels, const CoarseImage& base, float log_reference, const Collimator& collimator,
                       const std::vector<std::uint16_t>& raw)
{
  const float shutter = settings_.inverted ? kShutter : -kShutter;
  const auto n = static_cast<std::size_t>(pixels), stride = n + 2;
  detail_.resize(stride * stride);
  std::vector<float> shift(n);
  for (std::size_t row = 0; row < n; ++row)
  {
    base.row(static_cast<int>(row), shift.data());
    if (!collimator.isOpen())
      for (int column = 0; column < pixels; ++column)
        shift[static_cast<std::size_t>(column)] += shutter * (1.0F - collimator.share(static_cast<int>(row), column));
    logarithm(raw.data() + row * n, shift.data(), log_reference, detail_.data() + (row + 1) * stride + 1, pixels);
  }
}

void Display::filter()
{
  if (settings_.recursive_filter <= 0.0)
    return;
  if (has_previous_ && previous_.size() == detail_.size())
    mixFrames(static_cast<float>(settings_.recursive_filter), previous_.data(), detail_.data(), detail_.size());
  else
    previous_ = detail_;
  has_previous_ = true;
}

/** Replaces detail_ by its magnified central part. */
void Display::magnify(int pixels)
{
  if (settings_.zoom == 1.0)
    return;
  const auto stride = static_cast<std::size_t>(pixels) + 2;
  work_ = detail_;
  const double centre = 0.5 * (pixels - 1);
  const auto source = [&](int i) { return 1.0 + centre + (i - centre) / settings_.zoom; };  // with the margin
  for (int row = 0; row < pixels; ++row)
  {
    const double y = source(row);
    const auto y0 = static_cast<std::size_t>(y);
    const auto v = static_cast<float>(y - static_cast<double>(y0));
    for (int column = 0; column < pixels; ++column)
    {
      const double x = source(column);
      const auto x0 = static_cast<std::size_t>(x);
      const auto u = static_cast<float>(x - static_cast<double>(x0));
      const float* p = work_.data() + y0 * stride + x0;
      const float top = p[0] + u * (p[1] - p[0]), bottom = p[stride] + u * (p[stride + 1] - p[stride]);
      detail_[(static_cast<std::size_t>(row) + 1) * stride + static_cast<std::size_t>(column) + 1] =
          top + v * (bottom - top);
    }
  }
}

void Display::draw(int pixels, double width, double reference, const CoarseImage& counts, const Collimator& collimator,
                   const std::vector<std::uint16_t>& raw, std::vector<std::uint8_t>& image)
{
  const auto n = static_cast<std::size_t>(pixels);
  const double log_reference = std::log(reference);
  CoarseImage base = counts;
  for (float& value : base.values())
    value = static_cast<float>(std::log(std::clamp(static_cast<double>(value), 0.5, kLargestCount)) - log_reference);
  const double sigma = kLocal / width * pixels;
  if (collimator.isOpen())
    base.blur(sigma, true);
  else
    base = extended(base, collimator, pixels, sigma);
  for (float& value : base.values())
    value =
        static_cast<float>(kSaturation * std::tanh(kCompression / kSaturation * static_cast<double>(value))) - value;
  compress(pixels, base, static_cast<float>(log_reference), collimator, raw);
  addOverlay(n);
  repeatEdge(n);
  filter();
  magnify(pixels);
  applyWindow(pixels, static_cast<float>(settings_.edge_enhancement), image);
}

void Display::drawDifference(int pixels, const Collimator& collimator, const std::vector<float>& difference,
                             std::vector<std::uint8_t>& image)
{
  constexpr float kScale = (kWhite - kBlack) / (kWhiteDifference - kBlackDifference);
  const float shutter = settings_.inverted ? kShutter : -kShutter;
  const auto n = static_cast<std::size_t>(pixels), stride = n + 2;
  detail_.resize(stride * stride);
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t column = 0; column < n; ++column)
    {
      const float share = collimator.share(static_cast<int>(row), static_cast<int>(column));
      detail_[(row + 1) * stride + column + 1] =
          kBlack + kScale * (difference[row * n + column] - kBlackDifference) + shutter * (1.0F - share);
    }
  repeatEdge(n);
  magnify(pixels);
  applyWindow(pixels, 0.0F, image);
}

void Display::addOverlay(std::size_t pixels)
{
  if (overlay_.size() != pixels * pixels)
    return;
  for (std::size_t row = 0; row < pixels; ++row)
    for (std::size_t column = 0; column < pixels; ++column)
      detail_[(row + 1) * (pixels + 2) + column + 1] += overlay_[row * pixels + column];
}

/** Fills the margin of detail_ with the pixels at the edge. */
void Display::repeatEdge(std::size_t pixels)
{
  const std::size_t stride = pixels + 2;
  for (std::size_t row = 1; row <= pixels; ++row)
  {
    detail_[row * stride] = detail_[row * stride + 1];
    detail_[row * stride + pixels + 1] = detail_[row * stride + pixels];
  }
  std::copy_n(detail_.begin() + static_cast<std::ptrdiff_t>(stride), stride, detail_.begin());
  std::copy_n(detail_.begin() + static_cast<std::ptrdiff_t>(pixels * stride), stride,
              detail_.begin() + static_cast<std::ptrdiff_t>((pixels + 1) * stride));
}

/** Grey values of detail_. @param edge weight of the edges */
void Display::applyWindow(int pixels, float edge, std::vector<std::uint8_t>& image) const
{
  const auto n = static_cast<std::size_t>(pixels), stride = n + 2;
  image.resize(n * n);
  const float sign = settings_.inverted ? -1.0F : 1.0F;
  for (std::size_t row = 0; row < n; ++row)
  {
    const float* middle = detail_.data() + (row + 1) * stride + 1;
    window(middle - stride, middle, middle + stride, edge, sign, image.data() + row * n, pixels);
  }
}

}  // namespace endovascular_sim::fluoroscopy
