#include "segmentation/view/straightened_view.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr int kMarks = 6;        ///< height of the marks [pixels]
constexpr int kGap = 4;          ///< between the two cuts [pixels]
constexpr int kWidest = 4000;    ///< of the picture [pixels]
constexpr double kPitch = 1e-4;  ///< least edge of a pixel [m]

/** Section at an arc length, linear between two sections. */
struct Station
{
  const Section* a;
  const Section* b;
  double t;

  Eigen::Vector3d point(bool second, double offset) const
  {
    const Eigen::Vector3d from = a->centre + offset * (second ? a->w : a->u);
    const Eigen::Vector3d to = b->centre + offset * (second ? b->w : b->u);
    return from + t * (to - from);
  }

  double edge(double angle) const { return a->radiusAt(angle) + t * (b->radiusAt(angle) - a->radiusAt(angle)); }
};

}  // namespace

std::uint8_t GreyWindow::grey(double value) const
{
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp((value - black) / (white - black), 0.0, 1.0)));
}

GreyWindow windowFor(const Scan& scan, double lumen)
{
  if (scan.modality() == image::Modality::kCt)
    return {-200.0, 800.0};
  return {0.0, 1.4 * lumen};
}

GreyPicture straightenedView(const Scan& scan, const LumenBranch& branch)
{
  const std::vector<double> arc = branch.arc();
  double widest = 0.0;
  for (const Section& section : branch.sections)
    widest = std::max(widest, *std::max_element(section.radii.begin(), section.radii.end()));
  const double pitch = std::max(kPitch, arc.back() / kWidest);
  const double half = 1.6 * widest + 2e-3;
  const int rows = 2 * static_cast<int>(half / pitch) + 1;
  GreyPicture picture;
  picture.width = std::max(2, static_cast<int>(arc.back() / pitch) + 1);
  picture.height = 2 * rows + kGap + 2 * kMarks;
  picture.pixels.assign(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height), 0);
  const GreyWindow window = windowFor(scan, branch.sections[branch.sections.size() / 2].lumen);
  const auto pixel = [&picture](int column, int row) -> std::uint8_t&
  {
    return picture.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                          static_cast<std::size_t>(column)];
  };
  std::size_t k = 0;
  for (int column = 0; column < picture.width; ++column)
  {
    const double s = std::min(column * pitch, arc.back());
    while (k + 2 < arc.size() && arc[k + 1] < s)
      ++k;
    const Station station{&branch.sections[k], &branch.sections[k + 1], (s - arc[k]) / (arc[k + 1] - arc[k])};
    for (const bool second : {false, true})
    {
      const int middle = kMarks + rows / 2 + (second ? rows + kGap : 0);
      for (int row = -(rows / 2); row <= rows / 2; ++row)
        pixel(column, middle + row) = window.grey(scan.at(station.point(second, row * pitch)));
      const double angle = second ? 0.5 * M_PI : 0.0;
      for (const double side : {1.0, -1.0})
      {
        const double edge = station.edge(side > 0.0 ? angle : angle + M_PI);
        const int row = static_cast<int>(std::lround(side * edge / pitch));
        if (std::abs(row) <= rows / 2)
          pixel(column, middle + row) = 255;
      }
    }
    if (column > 0 && std::floor(column * pitch / 0.01) > std::floor((column - 1) * pitch / 0.01))
      for (int row = 0; row < kMarks; ++row)
        pixel(column, row) = pixel(column, picture.height - 1 - row) = 255;
  }
  return picture;
}

}  // namespace endovascular_sim::segmentation
