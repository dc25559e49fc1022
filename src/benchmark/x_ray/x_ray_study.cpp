#include "benchmark/x_ray/x_ray_study.h"

#include <algorithm>
#include <cmath>

#include "benchmark/x_ray/contrast_table.h"
#include "benchmark/x_ray/coronary_view.h"
#include "benchmark/x_ray/median_time.h"
#include "benchmark/x_ray/motion_tables.h"
#include "fluoroscopy/projection/vessel_projection.h"
#include "fluoroscopy/projection/wire_projection.h"
#include "geometry/loop_subdivision.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kStep = 1e-3;             // between two poses of a moving C-arm [rad]
constexpr int kFramesOfRefinement = 13;    // after the first frame at rest
constexpr float kSteelBehindBody = 0.02F;  // effective coefficient of steel behind the body [m²/kg]

void addPixels(CoronaryView& view, int pixels, int times, Section& section)
{
  simulation::FluoroscopySystem system = view.system(pixels);
  fluoroscopy::Fluoroscope& fluoroscope = system.fluoroscope();
  const std::vector<fluoroscopy::XRayWire> wires = view.wires(system);
  const double moving = medianOf(times,
                                 [&]
                                 {
                                   fluoroscopy::CArmPose pose = fluoroscope.geometry().pose();
                                   pose.primary_angle += kStep;
                                   fluoroscope.setPose(pose);
                                   fluoroscope.render(wires);
                                 });
  double refining = 0.0;
  for (int k = 0; k <= kFramesOfRefinement; ++k)
    refining = std::max(refining, medianOf(1, [&] { fluoroscope.render(wires); }));
  const double raw = medianOf(times, [&] { fluoroscope.render(wires, false); });
  const double displayed = medianOf(times, [&] { fluoroscope.render(wires, true); });
  fluoroscopy::WireProjection projection;
  fluoroscopy::WireShadow shadow;
  const fluoroscopy::DeviceCoefficients coefficients = fluoroscope.materials().coefficients(kSteelBehindBody);
  const double instruments =
      medianOf(times,
               [&]
               {
                 projection.project(
                     fluoroscope.geometry(), wires, [&](std::uint32_t) { return coefficients; }, shadow);
               });
  section.table.add({std::to_string(pixels), number(raw), number(displayed), number(instruments), number(moving),
                     number(refining), std::to_string(shadow.pixels.size())});
}

Section frames(CoronaryView& view, const StudyOptions& options, const Progress& progress)
{
  Section section(xRayTables(), "x_ray_frames");
  section.text =
      "Default anatomy with the body of `pci`, RAO 30 CAU 20, field 0.3 m; guidewire, soft wire and catheter from the "
      "femoral artery into the anterior descending artery. Processor time of one thread, medians. At rest: vessel and "
      "body are in the cache. After a movement: the C-arm turns by 1 mrad before each frame. Refinement: the most "
      "expensive of the frames in which the body is projected at 256².";
  const std::vector<int> sides = options.quick ? std::vector<int>{256, 512} : std::vector<int>{256, 512, 1024};
  double done = 0.0;
  for (const int pixels : sides)
  {
    progress(0.6 * done / static_cast<double>(sides.size()), std::to_string(pixels) + "² pixels");
    addPixels(view, pixels, options.quick ? 5 : 25, section);
    done += 1.0;
  }
  return section;
}

Section triangles(CoronaryView& view, const StudyOptions& options, const Progress& progress)
{
  Section section(xRayTables(), "x_ray_triangles");
  section.text =
      "Path lengths of the default anatomy in the same view, with Loop subdivisions of its wall. The cost "
      "arises in the first frame after a movement of the C-arm or of the wall.";
  const int levels = options.quick ? 1 : 2;
  for (int level = 0; level <= levels; ++level)
  {
    progress(0.6 + 0.1 * level, std::to_string(level) + " subdivisions");
    const geometry::TriangleMesh mesh = geometry::loopSubdivision(view.vessel.mesh, level);
    std::vector<std::string> row = {std::to_string(mesh.triangles.size())};
    for (const int pixels : {256, 512, 1024})
    {
      fluoroscopy::CArmPose pose = view.system(64).fluoroscope().geometry().pose();
      pose.pixels = pixels;
      const fluoroscopy::XRayGeometry geometry(pose);
      row.push_back(number(medianOf(options.quick ? 3 : 9, [&] { vesselPathLength(geometry, mesh); })));
    }
    section.table.add(row);
  }
  return section;
}

}  // namespace

std::vector<TableSpec> xRayTables()
{
  return {{"x_ray_frames",
           "Frames",
           {"pixels per side", "image_raw [ms]", "with display [ms]", "instruments [ms]", "after a movement [ms]",
            "refinement [ms]", "pixels with instruments"},
           ""},
          {"x_ray_triangles", "Path lengths in the vessel", {"triangles", "256² [ms]", "512² [ms]", "1024² [ms]"}, ""},
          contrastTable(),
          motionCostTable(),
          motionErrorTable()};
}

std::vector<Section> xRayStudy(const StudyOptions& options, const Progress& progress)
{
  progress(0.0, "vessel and body");
  CoronaryView view;
  std::vector<Section> sections;
  sections.push_back(frames(view, options, progress));
  sections.push_back(triangles(view, options, progress));
  progress(0.85, "contrast medium");
  sections.push_back(contrastCost(view, options));
  progress(0.9, "moving patient");
  sections.push_back(motionCost(view, options));
  sections.push_back(motionErrors(view, options));
  return sections;
}

}  // namespace endovascular_sim::benchmark
