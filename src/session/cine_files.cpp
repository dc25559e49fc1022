#include "session/cine_files.h"

#include <cmath>
#include <cstdlib>

#include "common/error.h"
#include "common/output_file.h"
#include "common/text/format.h"
#include "fluoroscopy/image/png_writer.h"

namespace endovascular_sim::session
{
namespace
{

constexpr auto kCine = "cine";
constexpr auto kDsa = "dsa";

std::string folderOf(const std::string& kind, std::size_t detector)
{
  return kind + (detector == 0 ? "" : formatted("_%zu", detector + 1));
}

}  // namespace

CineTime cineTimeOf(const std::string& text)
{
  char* end = nullptr;
  CineTime time;
  time.begin = std::strtod(text.c_str(), &end);
  const bool has_begin = end != text.c_str() && *end == ':';
  const char* const second = has_begin ? end + 1 : end;
  time.end = std::strtod(second, &end);
  if (!has_begin || end == second || *end != '\0' || !std::isfinite(time.end) || !(time.begin >= 0.0) ||
      !(time.begin <= time.end))
    throw InputError("X-ray run", "time",
                     "'" + text + "' is no interval; give the simulated times of its beginning and end [s], as 2.5:4");
  return time;
}

CineFiles::CineFiles(const World& world, const XRayRunSettings& settings, const CineTime& time,
                     const std::string& folder)
  : run_(world, settings),
    first_(run_.pulses().firstFrom(stepsUntil(time.begin, world.scene().solver.time_step))),
    last_(run_.pulses().newestAt(
        static_cast<std::uint64_t>(std::floor(time.end / world.scene().solver.time_step + 1e-6)))),
    folder_(folder)
{
  const auto frames = static_cast<long long>(last_) - static_cast<long long>(first_) + 1;
  if (frames < 1)
    throw InputError("X-ray run", "time",
                     formatted("%g:%g s has no pulse; there is one every %.4g s", time.begin, time.end,
                               1.0 / world.scene().fluoroscopy->rate));
  run_.requireFrames(first_, last_);
  for (std::size_t detector = 0; detector < run_.detectors(); ++detector)
  {
    createFolder(folder_ + "/" + folderOf(kCine, detector));
    if (settings.mask_frames > 0)
      createFolder(folder_ + "/" + folderOf(kDsa, detector));
  }
  const std::string table = folder_ + "/" + kCine + "/frames.csv";
  table_.open(table);
  if (!table_)
    throw writeError(table);
  table_ << "pulse,time,steps,tube_charge,reference_kerma,dsa\n";
}

void CineFiles::write(const std::string& kind, std::size_t detector, std::uint64_t pulse, int pixels,
                      const std::vector<std::uint8_t>& image) const
{
  fluoroscopy::writePng(
      folder_ + "/" + folderOf(kind, detector) + formatted("/frame_%06llu.png", static_cast<unsigned long long>(pulse)),
      pixels, pixels, image);
}

void CineFiles::update(const Session& session)
{
  const simulation::Simulation& simulation = session.simulation();
  const std::uint64_t pulse = run_.pulses().newestAt(simulation.steps());
  if (!run_.isDue(simulation) || pulse < first_ || pulse > last_)
    return;
  run_.draw(session);
  for (std::size_t detector = 0; detector < run_.detectors(); ++detector)
  {
    const fluoroscopy::AngiographyFrame& frame = run_.frame(detector);
    write(kCine, detector, pulse, frame.native.pixels, frame.native.image);
    if (!frame.subtracted.empty())
      write(kDsa, detector, pulse, frame.native.pixels, frame.subtracted);
  }
  const fluoroscopy::AngiographyFrame& frame = run_.frame();
  table_ << formatted("%llu,%.17g,%llu,%.9g,%.9g,%d\n", static_cast<unsigned long long>(pulse), simulation.time(),
                      static_cast<unsigned long long>(simulation.steps()), frame.native.tube_charge,
                      frame.native.reference_kerma, frame.subtracted.empty() ? 0 : 1);
  ++frames_;
}

std::string CineFiles::finish()
{
  if (!table_.flush())
    throw writeError(folder_ + "/" + kCine + "/frames.csv");
  const std::uint64_t wanted = last_ - first_ + 1;
  if (frames_ == wanted)
    return "";
  return formatted(
      "only %llu of %llu X-ray frames lie between beginning and end of the simulation; give another "
      "interval, or simulate longer",
      static_cast<unsigned long long>(frames_), static_cast<unsigned long long>(wanted));
}

}  // namespace endovascular_sim::session
