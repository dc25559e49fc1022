#include "benchmark/x_ray/contrast_table.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/x_ray/median_time.h"
#include "benchmark/x_ray/moving_adult.h"
#include "contrast/lumen/divide_lumen.h"
#include "geometry/polyline.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kCellLength = 2.5e-3;    // [m]
constexpr double kConcentration = 150.0;  // [mgI/ml]
constexpr double kTurn = 1e-3;            // between two poses of a moving C-arm [rad]

/** Cells of equal length on each branch, from a radius of its parent on. */
contrast::ContrastCells cellsOf(const vessel::CentrelineTree& tree)
{
  contrast::ContrastCells cells;
  std::vector<int> last(tree.branches.size(), -1);
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const vessel::CentrelineBranch& branch = tree.branches[b];
    const geometry::Polyline line(branch.points);
    const bool root = branch.parent < 0;
    const double inside = root ? 0.0 : tree.branches[static_cast<std::size_t>(branch.parent)].radii.back();
    const double begin = std::min(inside, 0.5 * line.length());
    const double longest = std::max(kCellLength, 0.45 * branch.radii[branch.radii.size() / 2]);
    const int count = std::max(1, static_cast<int>(std::ceil((line.length() - begin) / longest)));
    const double step = (line.length() - begin) / count;
    int parent = root ? -1 : last[static_cast<std::size_t>(branch.parent)];
    for (int k = 0; k < count; ++k)
    {
      cells.push_back({static_cast<int>(b), begin + step * k, begin + step * (k + 1), parent});
      parent = static_cast<int>(cells.size()) - 1;
    }
    last[b] = parent;
  }
  return cells;
}

/** Concentrations of an injection into a branch and all behind it; into the root: everywhere. */
std::vector<double> injectedInto(const std::string& name, const vessel::CentrelineTree& tree,
                                 const contrast::ContrastCells& cells)
{
  std::vector<bool> filled(tree.branches.size(), false);
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const int parent = tree.branches[b].parent;
    filled[b] =
        name.empty() || tree.branches[b].name == name || (parent >= 0 && filled[static_cast<std::size_t>(parent)]);
  }
  std::vector<double> result;
  for (const contrast::ContrastCell& cell : cells)
    result.push_back(filled[static_cast<std::size_t>(cell.branch)] ? kConcentration * (1.0 + cell.begin) : 0.0);
  return result;
}

std::vector<double> scaled(std::vector<double> values, double factor)
{
  for (double& value : values)
    value *= factor;
  return values;
}

/** Medians of frames without and with contrast medium, which differs in every frame [ms]. */
struct Times
{
  double without = 0.0, with = 0.0;
};

template <typename Next>
Times timesOf(fluoroscopy::Fluoroscope& fluoroscope, const std::vector<fluoroscopy::XRayWire>& wires,
              const std::vector<double>& contrast, int frames, const Next& next)
{
  std::vector<double> without, with;
  for (int frame = 0; frame < frames; ++frame)
    for (const bool injected : {false, true})
    {
      const std::vector<double> present = scaled(contrast, injected ? 1.0 + 1e-3 * frame : 0.0);
      next(2 * frame + (injected ? 1 : 0));
      (injected ? with : without)
          .push_back(timeOf(
              [&]
              {
                fluoroscope.setContrast(present);
                fluoroscope.render(wires);
              }));
    }
  return {medianOf(std::move(without)), medianOf(std::move(with))};
}

}  // namespace

TableSpec contrastTable()
{
  return {"x_ray_contrast",
          "Frames with contrast medium",
          {"pixels per side", "contrast in", "at rest, without [ms]", "with [ms]", "after a movement, without [ms]",
           "with [ms]", "moving patient, without [ms]", "with [ms]"},
          ""};
}

Section contrastCost(CoronaryView& view, const StudyOptions& options)
{
  Section section({contrastTable()}, "x_ray_contrast");
  section.text =
      "The same view and instruments, in the anatomy divided into cells of 2.5 mm. The concentrations change in every "
      "frame. After a movement: the C-arm turns by 1 mrad before each frame. Moving patient: heart and lungs of an "
      "adult, "
      "in every frame by another phase.";
  const contrast::ContrastCells cells = cellsOf(view.vessel.centreline);
  const auto lumen = std::make_shared<const contrast::LumenCells>(
      contrast::divideLumen(view.vessel.mesh, view.vessel.centreline, cells));
  const MovingAdult adult(view.vessel);
  const int frames = options.quick ? 9 : 45;
  for (const int pixels : options.quick ? std::vector<int>{512} : std::vector<int>{256, 512, 1024})
    for (const std::string& name : {std::string("left_main"), std::string()})
    {
      simulation::FluoroscopySystem system = view.system(pixels);
      fluoroscopy::Fluoroscope& fluoroscope = system.fluoroscope();
      system.setLumen(view.vessel.centreline, cells, lumen);
      const std::vector<fluoroscopy::XRayWire> wires = view.wires(system);
      const std::vector<double> contrast = injectedInto(name, view.vessel.centreline, cells);
      for (int frame = 0; frame < 15; ++frame)
        fluoroscope.render(wires);
      const Times rest = timesOf(fluoroscope, wires, contrast, frames, [](int) {});
      const Times moved = timesOf(fluoroscope, wires, contrast, frames / 3,
                                  [&](int)
                                  {
                                    fluoroscopy::CArmPose pose = fluoroscope.geometry().pose();
                                    pose.primary_angle += kTurn;
                                    fluoroscope.setPose(pose);
                                  });
      const Times beating = timesOf(fluoroscope, wires, contrast, 2 * frames,
                                    [&](int frame) { fluoroscope.setMotion(adult.ofFrame(frame)); });
      section.table.add({std::to_string(pixels), name.empty() ? "whole vessel" : "left coronary artery",
                         number(rest.without), number(rest.with), number(moved.without), number(moved.with),
                         number(beating.without), number(beating.with)});
    }
  return section;
}

}  // namespace endovascular_sim::benchmark
