#include "segmentation/view/straightened_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "segmentation/lumen/path_turns.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr int kMarks = 6;        ///< height of the marks [pixels]
constexpr int kGap = 4;          ///< between cuts, strip and legend [pixels]
constexpr int kLegend = 11;      ///< height of a line of the legend [pixels]
constexpr int kWidest = 4000;    ///< of the picture [pixels]
constexpr double kPitch = 1e-4;  ///< least edge of a pixel [m]
constexpr int kSwatch = 7;       ///< edge of a square of the legend [pixels]
constexpr int kEntry = 86;       ///< width of an entry of the legend [pixels]
constexpr int kRowsPerRay = 2;   ///< of the strip

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

/** Colours of the rays of all sections. */
std::vector<std::array<Colour, kRays>> coloursOf(const LumenBranch& branch, const OtherLumen& other)
{
  std::vector<std::array<Colour, kRays>> colours(branch.sections.size());
  for (std::size_t k = 0; k < branch.sections.size(); ++k)
    for (int ray = 0; ray < kRays; ++ray)
    {
      const auto r = static_cast<std::size_t>(ray);
      const Section& section = branch.sections[k];
      const RayEnd end = section.ends[r];
      Colour& colour = colours[k][r];
      if (end == RayEnd::kWall)
        colour = kWallColour;
      else if (end == RayEnd::kCalcium)
        colour = kCalciumColour;
      else if (end == RayEnd::kBone)
        colour = kBoneColour;
      else
        colour = runsThroughOther(section, ray, other) ? kJunctionColour : kOpenColour;
    }
  return colours;
}

/** Picture of one branch. */
class StraightenedBranch
{
public:
  StraightenedBranch(const Scan& scan, const LumenBranch& branch, const OtherLumen& other)
    : scan_(scan),
      branch_(branch),
      arc_(branch.arc()),
      colours_(coloursOf(branch, other)),
      window_(windowFor(scan, branch.sections[branch.sections.size() / 2].lumen))
  {
    double widest = 0.0;
    for (const Section& section : branch.sections)
      widest = std::max(widest, *std::max_element(section.radii.begin(), section.radii.end()));
    pitch_ = std::max(kPitch, arc_.back() / kWidest);
    rows_ = 2 * static_cast<int>((1.6 * widest + 2e-3) / pitch_) + 1;
    picture_ = ColourPicture(std::max(2 * kEntry, columns()),
                             stripRow() + kRays * kRowsPerRay + kMarks + kGap + legendLines() * kLegend);
  }

  ColourPicture run()
  {
    std::size_t k = 0;
    for (int column = 0; column < columns(); ++column)
    {
      const double s = std::min(column * pitch_, arc_.back());
      while (k + 2 < arc_.size() && arc_[k + 1] < s)
        ++k;
      const double t = (s - arc_[k]) / (arc_[k + 1] - arc_[k]);
      drawCuts(column, {&branch_.sections[k], &branch_.sections[k + 1], t}, colours_[t < 0.5 ? k : k + 1]);
      drawStrip(column, colours_[t < 0.5 ? k : k + 1]);
      if (column > 0 && std::floor(column * pitch_ / 0.01) > std::floor((column - 1) * pitch_ / 0.01))
        drawMark(column, kWallColour);
    }
    for (const Stretch& turn : turnsOf(branch_))
      for (int column = static_cast<int>(turn.from / pitch_); column <= static_cast<int>(turn.to / pitch_); ++column)
        drawMark(column, kTurnColour);
    drawLegend();
    return std::move(picture_);
  }

private:
  struct Entry
  {
    const char* name;
    Colour colour;
  };
  static const std::array<Entry, 5>& entries()
  {
    static const std::array<Entry, 5> kEntries = {{{"NO EDGE", kOpenColour},
                                                   {"JUNCTION", kJunctionColour},
                                                   {"CALCIUM", kCalciumColour},
                                                   {"BONE", kBoneColour},
                                                   {"PATH TURNS", kTurnColour}}};
    return kEntries;
  }
  int columns() const { return std::max(2, static_cast<int>(arc_.back() / pitch_) + 1); }
  int entriesPerLine() const { return std::max(1, std::max(2 * kEntry, columns()) / kEntry); }
  int legendLines() const { return (static_cast<int>(entries().size()) + entriesPerLine() - 1) / entriesPerLine(); }
  int stripRow() const { return kMarks + 2 * (rows_ + kGap); }

  void drawCuts(int column, const Station& station, const std::array<Colour, kRays>& colours)
  {
    for (const bool second : {false, true})
    {
      const int middle = kMarks + rows_ / 2 + (second ? rows_ + kGap : 0);
      for (int row = -(rows_ / 2); row <= rows_ / 2; ++row)
        picture_.set(column, middle + row, greyOf(window_.grey(scan_.at(station.point(second, row * pitch_)))));
      for (const bool opposite : {false, true})
      {
        const int ray = (second ? kRays / 4 : 0) + (opposite ? kRays / 2 : 0);
        const double edge = station.edge(2.0 * M_PI * ray / kRays);
        const int row = static_cast<int>(std::lround((opposite ? -edge : edge) / pitch_));
        if (std::abs(row) <= rows_ / 2)
          picture_.set(column, middle + row, colours[static_cast<std::size_t>(ray)]);
      }
    }
  }

  void drawStrip(int column, const std::array<Colour, kRays>& colours)
  {
    for (int row = 0; row < kRays * kRowsPerRay; ++row)
    {
      const Colour& colour = colours[static_cast<std::size_t>(row / kRowsPerRay)];
      picture_.set(column, stripRow() + row, colour == kWallColour ? greyOf(0) : colour);
    }
  }

  void drawMark(int column, const Colour& colour)
  {
    for (int row = 0; row < kMarks; ++row)
    {
      picture_.set(column, row, colour);
      picture_.set(column, stripRow() + kRays * kRowsPerRay + row, colour);
    }
  }

  void drawLegend()
  {
    const int top = stripRow() + kRays * kRowsPerRay + kMarks + kGap;
    for (int n = 0; n < static_cast<int>(entries().size()); ++n)
    {
      const Entry& entry = entries()[static_cast<std::size_t>(n)];
      const int column = n % entriesPerLine() * kEntry;
      const int row = top + n / entriesPerLine() * kLegend;
      for (int y = 0; y < kSwatch; ++y)
        for (int x = 0; x < kSwatch; ++x)
          picture_.set(column + x, row + y, entry.colour);
      picture_.draw(column + kSwatch + 3, row, entry.name, kWallColour);
    }
  }

  const Scan& scan_;
  const LumenBranch& branch_;
  std::vector<double> arc_;
  std::vector<std::array<Colour, kRays>> colours_;
  GreyWindow window_;
  double pitch_ = kPitch;  ///< edge of a pixel [m]
  int rows_ = 0;           ///< of a cut
  ColourPicture picture_;
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

ColourPicture straightenedView(const Scan& scan, const LumenBranch& branch, const OtherLumen& other)
{
  return StraightenedBranch(scan, branch, other).run();
}

}  // namespace endovascular_sim::segmentation
