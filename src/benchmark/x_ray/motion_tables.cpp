#include "benchmark/x_ray/motion_tables.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "benchmark/x_ray/median_time.h"
#include "benchmark/x_ray/moving_adult.h"
#include "common/text/format.h"
#include "fluoroscopy/motion/phase_grid.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "fluoroscopy/projection/moving_vessel.h"
#include "fluoroscopy/projection/vessel_projection.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::benchmark
{
namespace
{

using fluoroscopy::ArealDensityImage;
using fluoroscopy::BodyMotion;
using fluoroscopy::MotionSampling;

constexpr int kFramesPerSecond = 15;

/** Times of the frames in motion [ms]. */
struct MotionTimes
{
  std::vector<double> projected, taken;  ///< frames that project the body, and that take an earlier phase
  double taken_share = 0.0;              ///< of the last third of the frames
};

MotionTimes timesOf(fluoroscopy::Fluoroscope& fluoroscope, const fluoroscopy::ProgressiveProjection& body,
                    const std::vector<fluoroscopy::XRayWire>& wires, const MovingAdult& adult, int frames)
{
  MotionTimes times;
  int late = 0, late_taken = 0;
  for (int frame = 1; frame <= frames; ++frame)
  {
    const BodyMotion motion = adult.ofFrame(frame);
    const std::uint64_t before = body.movedFrames() - body.reusedFrames();
    const double time = timeOf(
        [&]
        {
          fluoroscope.setMotion(motion);
          fluoroscope.render(wires);
        });
    const bool taken = body.movedFrames() - body.reusedFrames() == before;
    (taken ? times.taken : times.projected).push_back(time);
    late += frame > frames * 2 / 3 ? 1 : 0;
    late_taken += taken && frame > frames * 2 / 3 ? 1 : 0;
  }
  times.taken_share = static_cast<double>(late_taken) / late;
  return times;
}

std::pair<double, double> vesselTimes(const CoronaryView& view, const fluoroscopy::XRayGeometry& geometry,
                                      const MovingAdult& adult)
{
  const double whole = medianOf(9, [&] { vesselPathLength(geometry, view.vessel.mesh); });
  fluoroscopy::MovingVessel vessel;
  vessel.setMesh(view.vessel.mesh);
  int frame = 1;
  vessel.project(geometry, adult.ofFrame(frame).map());
  const double moving = medianOf(9, [&] { vessel.project(geometry, adult.ofFrame(++frame).map()); });
  return {whole, moving};
}

/** Largest and RMS difference of two images [kg/m²]. */
struct Difference
{
  double rms = 0.0, largest = 0.0;
};

Difference between(const std::vector<float>& a, const std::vector<float>& b)
{
  Difference result;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    const double d = std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k]));
    result.rms += d * d;
    result.largest = std::max(result.largest, d);
  }
  result.rms = std::sqrt(result.rms / static_cast<double>(a.size()));
  return result;
}

std::vector<std::string> cells(const Difference& difference)
{
  return {number(difference.rms), number(difference.largest)};
}

/** Phase next to another one at which a change of that one would just be taken. */
BodyMotion atTolerance(const MovingAdult& adult, double heart, double breath)
{
  const BodyMotion wanted = adult.at(heart, breath);
  BodyMotion last = wanted;
  for (double step = 1e-4; step < 0.3; step += 1e-4)
  {
    const BodyMotion next = adult.at(std::fmod(heart + 0.5 * step, 1.0), std::fmod(breath + step, 1.0));
    if (fluoroscopy::distanceBetween(wanted, next) > fluoroscopy::PhaseGrid::kTolerance)
      break;
    last = next;
  }
  return last;
}

}  // namespace

TableSpec motionCostTable()
{
  return {"x_ray_motion",
          "Frames of a moving patient",
          {"pixels per side", "at rest [ms]", "projected [ms]", "earlier phase [ms]", "share of earlier phases [%]",
           "vessel, whole [ms]", "vessel, moving part [ms]", "patient, exact [ms]"},
          ""};
}

TableSpec motionErrorTable()
{
  return {
      "x_ray_motion_errors",
      "Errors of frames of a moving patient",
      {"view", "phase", "RMS change [kg/m²]", "largest change [kg/m²]", "fast: RMS [kg/m²]", "fast: largest [kg/m²]",
       "earlier phase: RMS [kg/m²]", "earlier phase: largest [kg/m²]", "frame: RMS [kg/m²]", "frame: largest [kg/m²]"},
      ""};
}

Section motionCost(CoronaryView& view, const StudyOptions& options)
{
  Section section({motionCostTable()}, "x_ray_motion");
  section.text = formatted(
      "The same view, instruments and body; heart and lungs of an adult move, in every frame by another phase (71 "
      "beats "
      "and 14.8 breaths per minute at 15 frames per second). Projected: the moved body is projected. Earlier phase: "
      "its "
      "change is that of an earlier frame; their share is that of the last third of %s. At rest: without motion. "
      "Exact: "
      "projection of the change with every sample pulled back, as single images take it, at 128².",
      options.quick ? "10 s" : "60 s");
  const MovingAdult adult(view.vessel);
  const auto projection =
      std::make_shared<const fluoroscopy::VolumeProjection>(*simulation::patientVolume(view.scene, view.vessel).volume);
  for (const int pixels : options.quick ? std::vector<int>{512} : std::vector<int>{256, 512, 1024})
  {
    simulation::FluoroscopySystem system = view.system(pixels);
    fluoroscopy::Fluoroscope& fluoroscope = system.fluoroscope();
    auto owned = std::make_unique<fluoroscopy::ProgressiveProjection>(projection,
                                                                      simulation::sequenceResolution(kFramesPerSecond));
    const fluoroscopy::ProgressiveProjection& body = *owned;
    fluoroscope.setPatient(std::move(owned));
    fluoroscope.setPhases(std::make_shared<const fluoroscopy::PhaseGrid>(adult.motion()));
    const std::vector<fluoroscopy::XRayWire> wires = view.wires(system);
    for (int frame = 0; frame < kFramesPerSecond; ++frame)
      fluoroscope.render(wires);
    const double at_rest = medianOf(options.quick ? 5 : 25, [&] { fluoroscope.render(wires); });
    MotionTimes times = timesOf(fluoroscope, body, wires, adult, kFramesPerSecond * (options.quick ? 10 : 60));
    const auto [whole, moving] = vesselTimes(view, fluoroscope.geometry(), adult);
    fluoroscopy::MovedTissue tissue(*projection, adult.heart());
    const BodyMotion motion = adult.at(adult.systole(), adult.inspiration());
    const double exact =
        medianOf(5, [&] { tissue.change(fluoroscope.geometry(), 128, motion, MotionSampling::kExact); });
    section.table.add({std::to_string(pixels), number(at_rest), number(medianOf(times.projected)),
                       number(medianOf(times.taken)), number(100.0 * times.taken_share), number(whole), number(moving),
                       number(exact)});
  }
  return section;
}

Section motionErrors(CoronaryView& view, const StudyOptions& /*options*/)
{
  Section section({motionErrorTable()}, "x_ray_motion_errors");
  section.text =
      "Areal density of soft tissue in the moved body, 256² rays. Fast: displacements are interpolated. Earlier phase: "
      "besides, the change is that of a phase at the tolerance. Frame: image at rest at 256² with the fast change at "
      "128², against the exact projection at 256². 1 kg/m² changes the signal by about 2 %.";
  const MovingAdult adult(view.vessel);
  const fluoroscopy::VolumeProjection projection(*simulation::patientVolume(view.scene, view.vessel).volume);
  fluoroscopy::MovedTissue tissue(projection, adult.heart());
  const std::pair<const char*, std::pair<double, double>> phases[] = {
      {"end-systole", {adult.systole(), 0.0}},
      {"end-inspiration", {0.0, adult.inspiration()}},
      {"mid-systole, mid-inspiration", {0.5 * adult.systole(), 0.5 * adult.inspiration()}}};
  fluoroscopy::CArmPose pose = view.system(256).fluoroscope().geometry().pose();
  for (const char* name : {"RAO 30 CAU 20", "AP"})
  {
    if (std::string(name) == "AP")
      pose.primary_angle = pose.secondary_angle = 0.0;
    const fluoroscopy::XRayGeometry geometry(pose);
    const ArealDensityImage still = projection.project(geometry, 256);
    for (const auto& [phase, at] : phases)
    {
      const BodyMotion motion = adult.at(at.first, at.second);
      const std::vector<float> exact = tissue.change(geometry, 256, motion, MotionSampling::kExact);
      const std::vector<float> fast = tissue.change(geometry, 256, motion, MotionSampling::kFast);
      const std::vector<float> earlier =
          tissue.change(geometry, 256, atTolerance(adult, at.first, at.second), MotionSampling::kFast);
      std::vector<float> moved = still.tissue, frame = still.tissue;
      fluoroscopy::addResampled(exact, 256, 256, moved);
      fluoroscopy::addResampled(tissue.change(geometry, 128, motion, MotionSampling::kFast), 128, 256, frame);
      std::vector<std::string> row = {name, phase};
      for (const Difference& difference : {between(exact, std::vector<float>(exact.size())), between(fast, exact),
                                           between(earlier, exact), between(frame, moved)})
        for (const std::string& cell : cells(difference))
          row.push_back(cell);
      section.table.add(row);
    }
  }
  return section;
}

}  // namespace endovascular_sim::benchmark
