#pragma once

#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::results
{

/** A curve of a plot. */
struct PlotLine
{
  std::string name;  ///< in the legend; empty: not there
  std::string colour;
  std::vector<std::pair<double, double>> points;
};

/** A stretch of the abscissa that is shaded, with its name. */
struct PlotBand
{
  std::string name;
  double begin = 0.0;
  double end = 0.0;
};

/** A plot with axes in round numbers, as an SVG element. */
struct SvgPlot
{
  std::string title;
  std::string abscissa;  ///< with its unit
  std::string ordinate;  ///< with its unit
  std::vector<PlotLine> lines;
  std::vector<PlotBand> bands;
  bool equal_scales = false;             ///< for maps: both axes with the same scale
  double width = 900.0, height = 240.0;  ///< pixels

  std::string text() const;
};

/** Text for HTML: the signs that it reserves replaced. */
std::string escaped(const std::string& text);

/** One of a few colours that can be told apart. */
const char* colour(std::size_t k);

}  // namespace endovascular_sim::results
