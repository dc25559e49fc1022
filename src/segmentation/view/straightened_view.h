#pragma once

#include <cstdint>

#include "segmentation/lumen/open_stretch.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"
#include "segmentation/view/colour_picture.h"

namespace endovascular_sim::segmentation
{

/** Colours of the contour and of the legend. @{ */
constexpr Colour kWallColour = {255, 255, 255};    ///< edge of the lumen
constexpr Colour kOpenColour = {255, 40, 40};      ///< no edge, or one that does not fit those of the neighbours
constexpr Colour kCalciumColour = {255, 200, 0};   ///< edge at calcium
constexpr Colour kBoneColour = {0, 200, 255};      ///< edge before bone
constexpr Colour kTurnColour = {255, 0, 255};      ///< turn of the path
constexpr Colour kJunctionColour = {90, 90, 160};  ///< no edge, because the ray runs into another branch
/** @} */

/** Straightened view of a branch: two perpendicular cuts along its centreline, one above the other, with the contour.
 * The strip below them is the unrolled wall: a row per ray, black where the ray has found the edge. The colours show
 * what is doubtful. The branch begins on the left. Marks above and below are 10 mm apart.
 *  @param other lumens of the other branches; may be empty */
ColourPicture straightenedView(const Scan& scan, const LumenBranch& branch, const OtherLumen& other);

/** Range of values that pictures show: black and white. */
struct GreyWindow
{
  double black = 0.0;
  double white = 0.0;

  std::uint8_t grey(double value) const;
};

/** Window around a lumen: −200 to 800 HU of a CT, or up to 1.4 times the lumen. */
GreyWindow windowFor(const Scan& scan, double lumen);

}  // namespace endovascular_sim::segmentation
