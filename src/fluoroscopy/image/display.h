#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "fluoroscopy/image/coarse_image.h"
#include "fluoroscopy/image/collimator.h"

namespace endovascular_sim::fluoroscopy
{

/** Settings of the display image. */
struct DisplaySettings
{
  double edge_enhancement = 0.3;  ///< weight of the difference to the mean of 3 × 3 pixels, 0 to 4
  double zoom = 1.0;              ///< magnification of the central part, 1 to 8
  bool inverted = false;          ///< true: bones and contrast medium are bright
  double recursive_filter = 0.0;  ///< weight of the preceding frame, 0 to 0.95
};

/** Display image of angiography: logarithm, local range compression, edge enhancement, window.
 *
 *  With l = ln(count / count at the wanted dose) and its local mean b over 20 mm,
 *
 *      d = (l − b) + s·tanh(c b / s),  c = 0.32, s = 0.55,   grey = 255·(d + 1.35)/(0.85 + 1.35).
 *
 *  Detail keeps its contrast in dark and bright surroundings. The window does not depend on the frame. The recursive
 * filter acts on d, so that it affects the display only. An overlay, e.g. a roadmap, is added to d.
 *
 *  A difference s of logarithms (DSA) has a window of its own, without compression, enhancement and filter:
 * grey = 255·(s + 0.6)/(0.2 + 0.6). */
class Display
{
public:
  /** @throws InputError for settings out of range */
  explicit Display(const DisplaySettings& settings);

  /** Draws a frame.
   *  @param width width of the detector [m]
   *  @param reference count at the wanted dose
   *  @param counts mean count per bin
   *  @param collimator its blades are black; they do not contribute to the local mean */
  void draw(int pixels, double width, double reference, const CoarseImage& counts, const Collimator& collimator,
            const std::vector<std::uint16_t>& raw, std::vector<std::uint8_t>& image);

  /** Draws a difference of logarithms, e.g. of DSA.
   *  @param difference s, row-major */
  void drawDifference(int pixels, const Collimator& collimator, const std::vector<float>& difference,
                      std::vector<std::uint8_t>& image);

  /** Overlay of the frames from now on. @param overlay added to d, row-major; of another size: none */
  void setOverlay(std::vector<float> overlay) { overlay_ = std::move(overlay); }

  /** Forgets the preceding frame. */
  void reset() { has_previous_ = false; }

private:
  void compress(int pixels, const CoarseImage& base, float log_reference, const Collimator& collimator,
                const std::vector<std::uint16_t>& raw);
  void addOverlay(std::size_t pixels);
  void repeatEdge(std::size_t pixels);
  void filter();
  void magnify(int pixels);
  void applyWindow(int pixels, float edge, std::vector<std::uint8_t>& image) const;

  DisplaySettings settings_;
  bool has_previous_ = false;
  std::vector<float> detail_, previous_, work_, overlay_;
};

}  // namespace endovascular_sim::fluoroscopy
