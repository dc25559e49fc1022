#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace endovascular_sim::segmentation
{

/** Red, green, blue. */
using Colour = std::array<std::uint8_t, 3>;

constexpr Colour greyOf(std::uint8_t value)
{
  return {value, value, value};
}

/** Picture with three bytes per pixel, in row-major order from the top. */
struct ColourPicture
{
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  ColourPicture() = default;

  /** Black picture. */
  ColourPicture(int columns, int rows)
    : width(columns), height(rows), pixels(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0)
  {
  }

  /** Sets a pixel; nothing outside of the picture. */
  void set(int column, int row, const Colour& colour);

  Colour at(int column, int row) const;

  /** Draws a text of capitals A–Z and blanks, 7 pixels high.
   *  @return column behind it */
  int draw(int column, int row, const std::string& text, const Colour& colour);
};

}  // namespace endovascular_sim::segmentation
