#include "results/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/text/format.h"

namespace endovascular_sim::results
{
namespace
{

constexpr double kLeft = 60.0, kRight = 12.0, kTop = 26.0, kBottom = 40.0;  // margins around the axes [pixels]

/** Linear map of a range of values to a range of pixels. */
struct Axis
{
  double low = 0.0, high = 1.0, from = 0.0, to = 1.0;
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

std::string number(double value)
{
  return formatted("%.1f", value);
}

/** Tick spacing of 1, 2 or 5 times a power of ten with about @p count ticks in the range. */
double roundStep(double range, int count)
{
  const double raw = range / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw)
      return factor * power;
  return 10.0 * power;
}

void widen(Axis& axis)
{
  if (!(axis.high > axis.low))
  {
    axis.low -= 0.5;
    axis.high += 0.5;
  }
}

void equalise(Axis& x, Axis& y)
{
  const double scale = std::max((x.high - x.low) / (x.to - x.from), (y.high - y.low) / (y.from - y.to));
  for (Axis* axis : {&x, &y})
  {
    const double middle = 0.5 * (axis->low + axis->high);
    const double half = 0.5 * scale * std::abs(axis->to - axis->from);
    axis->low = middle - half;
    axis->high = middle + half;
  }
}

std::string textAt(double x, double y, const std::string& text, const std::string& style)
{
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + style + ">" + escaped(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* colour)
{
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
         "\" stroke=\"" + colour + "\"/>\n";
}

std::string axes(const Axis& x, const Axis& y)
{
  std::string svg;
  const double dx = roundStep(x.high - x.low, 9);
  for (double value = std::ceil(x.low / dx) * dx; value <= x.high; value += dx)
    svg += line(x.at(value), y.from, x.at(value), y.to, "#e4e4e4") +
           textAt(x.at(value), y.from + 14.0, formatted("%g", std::abs(value) < 1e-9 * dx ? 0.0 : value),
                  "text-anchor=\"middle\"");
  const double dy = roundStep(y.high - y.low, 5);
  for (double value = std::ceil(y.low / dy) * dy; value <= y.high; value += dy)
    svg += line(x.from, y.at(value), x.to, y.at(value), "#e4e4e4") +
           textAt(x.from - 5.0, y.at(value) + 4.0, formatted("%g", std::abs(value) < 1e-9 * dy ? 0.0 : value),
                  "text-anchor=\"end\"");
  return svg + line(x.from, y.from, x.to, y.from, "#444") + line(x.from, y.from, x.from, y.to, "#444");
}

std::string curve(const PlotLine& curve, const Axis& x, const Axis& y)
{
  std::string points;
  for (const auto& [a, b] : curve.points)
    points += number(x.at(a)) + "," + number(y.at(b)) + " ";
  return "<polyline fill=\"none\" stroke-width=\"1.4\" stroke=\"" + curve.colour + "\" points=\"" + points + "\"/>\n";
}

}  // namespace

std::string escaped(const std::string& text)
{
  std::string safe;
  for (const char c : text)
    switch (c)
    {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  return safe;
}

const char* colour(std::size_t k)
{
  static const std::array<const char*, 6> colours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#7f7f7f"};
  return colours[k % colours.size()];
}

std::string SvgPlot::text() const
{
  Axis x{INFINITY, -INFINITY, kLeft, width - kRight};
  Axis y{INFINITY, -INFINITY, height - kBottom, kTop};
  for (const PlotLine& one : lines)
    for (const auto& [a, b] : one.points)
    {
      x.low = std::min(x.low, a);
      x.high = std::max(x.high, a);
      y.low = std::min(y.low, b);
      y.high = std::max(y.high, b);
    }
  if (!std::isfinite(x.low))
    x = {0.0, 1.0, x.from, x.to}, y = {0.0, 1.0, y.from, y.to};
  widen(x);
  widen(y);
  if (equal_scales)
    equalise(x, y);
  std::string svg = "<svg viewBox=\"0 0 " + number(width) + " " + number(height) + "\" width=\"" + number(width) +
                    "\" height=\"" + number(height) + "\" font-family=\"sans-serif\" font-size=\"11\">\n";
  for (std::size_t k = 0; k < bands.size(); ++k)
    svg += "<rect x=\"" + number(x.at(bands[k].begin)) + "\" y=\"" + number(y.to) + "\" width=\"" +
           number(x.at(bands[k].end) - x.at(bands[k].begin)) + "\" height=\"" + number(y.from - y.to) + "\" fill=\"" +
           (k % 2 == 0 ? "#f3f6fa" : "#ffffff") + "\"><title>" + escaped(bands[k].name) + "</title></rect>\n";
  svg += axes(x, y);
  for (const PlotLine& one : lines)
    svg += curve(one, x, y);
  svg += textAt(kLeft, 15.0, title, "font-weight=\"bold\"");
  double legend = width - kRight;
  for (auto one = lines.rbegin(); one != lines.rend(); ++one)
  {
    if (one->name.empty())
      continue;
    svg += textAt(legend, 15.0, one->name, "text-anchor=\"end\" fill=\"" + one->colour + "\"");
    legend -= 12.0 + 6.5 * static_cast<double>(one->name.size());
  }
  svg += textAt(0.5 * (x.from + x.to), height - 6.0, abscissa, "text-anchor=\"middle\"");
  svg += "<text transform=\"translate(12," + number(0.5 * (y.from + y.to)) + ") rotate(-90)\" text-anchor=\"middle\">" +
         escaped(ordinate) + "</text>\n";
  return svg + "</svg>\n";
}

}  // namespace endovascular_sim::results
