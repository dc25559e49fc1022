#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "common/error.h"
#include "instrument/rest_shape.h"
#include "scene/instrument_library.h"

namespace
{
namespace fs = std::filesystem;
using namespace endovascular_sim;

constexpr auto kUsage = R"(Draws what instrument files describe: the shape at rest from two sides, diameter and bending
stiffness along the shaft, radiopaque markers, the chart of a balloon, the length of a stent.

usage: instrument_shape INSTRUMENT ... --out FILE.png | FILE.svg | FILE.csv [--set key.path=value ...]

  INSTRUMENT            a YAML file, or the name of one in config/instruments, e.g. catheter_5f_jl4; all: every one there
  --out FILE            .png, .svg: the drawing. .csv: its numbers, the shaft in FILE.csv, with FILE_markers.csv,
                        FILE_balloon.csv and FILE_stent.csv beside it where an instrument has them
  --set key.path=value  replaces a value in every instrument, e.g. --set tip.radius=0.005
  --help                prints this

exit code: 0 done, 1 an instrument is refused or the drawing failed (the reason goes to the error stream), 2 wrong use
)";

// Points of a drawn shape are at most this far apart [m].
constexpr double kSpacing = 0.5e-3;

struct Options
{
  std::vector<std::string> instruments;
  std::vector<std::string> overrides;
  fs::path out;
};

struct Drawn
{
  std::string title;
  instrument::Instrument instrument;
};

int wrongUse(const std::string& reason)
{
  std::cerr << "instrument_shape: " << reason << "\n" << kUsage;
  return 2;
}

/** A CSV file with a head line; throws when it cannot be written. */
class Table
{
public:
  Table(const fs::path& file, const std::string& head) : file_(file), stream_(file)
  {
    stream_.precision(9);
    stream_ << head << "\n";
  }

  std::ofstream& row() { return stream_; }

  void close()
  {
    stream_.close();
    if (!stream_)
      throw InputError(file_.string(), "", "cannot be written; give a file in an existing folder with --out");
  }

private:
  fs::path file_;
  std::ofstream stream_;
};

void writeShafts(const fs::path& file, const std::vector<Drawn>& all)
{
  Table table(file,
              "instrument,arc_length,x,y,z,section,material,diameter,inner_diameter,bending_stiffness,"
              "torsional_stiffness");
  for (const Drawn& drawn : all)
    for (const instrument::RestPoint& point : instrument::restShape(drawn.instrument.wire, kSpacing))
    {
      if (drawn.instrument.wire.sections.empty())
        continue;
      const rod::Section& section = drawn.instrument.wire.sections[point.section];
      table.row() << drawn.title << "," << point.arc_length << "," << point.position.x() << "," << point.position.y()
                  << "," << point.position.z() << "," << point.section << ","
                  << instrument::materialName(drawn.instrument.materials[point.section]) << "," << 2.0 * section.radius
                  << "," << 2.0 * drawn.instrument.inner_radius << "," << section.bending_stiffness << ","
                  << section.torsional_stiffness << "\n";
    }
  table.close();
}

void writeMarkers(const fs::path& file, const std::vector<Drawn>& all)
{
  Table table(file, "instrument,from_tip,length,material");
  for (const Drawn& drawn : all)
    for (const instrument::Marker& marker : drawn.instrument.markers)
      table.row() << drawn.title << "," << marker.from_tip << "," << marker.length << ","
                  << instrument::materialName(marker.material) << "\n";
  table.close();
}

void writeBalloons(const fs::path& file, const std::vector<Drawn>& all)
{
  constexpr int kPoints = 120;
  Table table(file,
              "instrument,pressure,diameter,nominal_pressure,rated_burst_pressure,burst_pressure,from_tip,length");
  for (const Drawn& drawn : all)
    for (int i = 0; drawn.instrument.balloon && i <= kPoints; ++i)
    {
      const instrument::Balloon& balloon = *drawn.instrument.balloon;
      const double pressure = balloon.burst_pressure * i / kPoints;
      table.row() << drawn.title << "," << pressure << "," << balloon.diameterAt(pressure) << ","
                  << balloon.nominal_pressure << "," << balloon.rated_burst_pressure << "," << balloon.burst_pressure
                  << "," << balloon.from_tip << "," << balloon.length << "\n";
    }
  table.close();
}

void writeStents(const fs::path& file, const std::vector<Drawn>& all)
{
  Table table(file, "instrument,diameter,length,nominal_diameter,crimped_diameter");
  for (const Drawn& drawn : all)
    if (drawn.instrument.stent)
      for (const auto& row : drawn.instrument.stent->expansion)
        table.row() << drawn.title << "," << row.diameter << "," << row.length << ","
                    << drawn.instrument.stent->nominal_diameter << "," << drawn.instrument.stent->crimped_diameter
                    << "\n";
  table.close();
}

bool any(const std::vector<Drawn>& all, bool (*has)(const instrument::Instrument&))
{
  for (const Drawn& drawn : all)
    if (has(drawn.instrument))
      return true;
  return false;
}

void writeTables(const fs::path& csv, const std::vector<Drawn>& all)
{
  const auto beside = [&csv](const std::string& what)
  { return csv.parent_path() / (csv.stem().string() + "_" + what + ".csv"); };
  writeShafts(csv, all);
  if (any(all, [](const instrument::Instrument& i) { return !i.markers.empty(); }))
    writeMarkers(beside("markers"), all);
  if (any(all, [](const instrument::Instrument& i) { return i.balloon.has_value(); }))
    writeBalloons(beside("balloon"), all);
  if (any(all, [](const instrument::Instrument& i) { return i.stent.has_value(); }))
    writeStents(beside("stent"), all);
}

/** Draws by plot_instruments.py, which lies beside this program. */
int draw(const fs::path& picture, const std::vector<Drawn>& all)
{
  const fs::path folder = fs::temp_directory_path() / ("instrument_shape_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  writeTables(folder / "shaft.csv", all);
  const fs::path script = fs::read_symlink("/proc/self/exe").parent_path() / "plot_instruments.py";
  const std::string command =
      "/usr/bin/python3 '" + script.string() + "' '" + folder.string() + "' '" + picture.string() + "'";
  const int status = std::system(command.c_str());
  fs::remove_all(folder);
  if (status != 0)
    std::cerr << "instrument_shape: the drawing failed (" << command << ")\n";
  return status == 0 ? 0 : 1;
}

std::vector<Drawn> readAll(const Options& options)
{
  std::vector<std::string> files;
  for (const std::string& word : options.instruments)
    if (word == "all")
      for (const std::string& name : scene::libraryNames())
        files.push_back(scene::libraryInstrument(name));
    else
      files.push_back(fs::is_regular_file(word) || fs::path(word).has_extension() ? word
                                                                                  : scene::libraryInstrument(word));
  std::vector<Drawn> all;
  for (const std::string& file : files)
    all.push_back({fs::path(file).stem().string(), scene::loadInstrument(file, options.overrides)});
  return all;
}

int run(const Options& options)
{
  try
  {
    const std::vector<Drawn> all = readAll(options);
    if (options.out.extension() != ".csv")
      return draw(options.out, all);
    writeTables(options.out, all);
  }
  catch (const std::exception& error)
  {
    std::cerr << "instrument_shape: " << error.what() << "\n";
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h")
    {
      std::cout << kUsage;
      return 0;
    }
    if ((word == "--out" || word == "--set") && i + 1 == argc)
      return wrongUse(word + " needs a value");
    if (word == "--out")
      options.out = argv[++i];
    else if (word == "--set")
      options.overrides.emplace_back(argv[++i]);
    else if (word.rfind("--", 0) == 0)
      return wrongUse("unknown option " + word);
    else
      options.instruments.push_back(word);
  }
  if (options.instruments.empty())
    return wrongUse("no instrument given");
  const std::string extension = options.out.extension().string();
  if (extension != ".png" && extension != ".svg" && extension != ".csv")
    return wrongUse("--out must be a .png, .svg or .csv file");
  return run(options);
}
