#pragma once

#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::results
{

/** Curve of a plot. */
struct PlotLine
{
  std::string name;  ///< name in the legend; empty: no legend entry
  std::string colour;
  std::vector<std::pair<double, double>> points;
};

/** Named, shaded interval of the abscissa. */
struct PlotBand
{
  std::string name;
  double begin = 0.0;
  double end = 0.0;
};

/** Plot as an SVG element, with round numbers on the axes. */
struct SvgPlot
{
  std::string title;
  std::string abscissa;  ///< label of the abscissa with its unit
  std::string ordinate;  ///< label of the ordinate with its unit
  std::vector<PlotLine> lines;
  std::vector<PlotBand> bands;
  bool equal_scales = false;             ///< true: both axes have the same scale, for maps
  double width = 900.0, height = 240.0;  ///< size of the image [pixels]

  std::string text() const;
};

/** Text with the reserved characters of HTML escaped. */
std::string escaped(const std::string& text);

/** Colour @p k of a palette of distinguishable colours. */
const char* colour(std::size_t k);

}  // namespace endovascular_sim::results
