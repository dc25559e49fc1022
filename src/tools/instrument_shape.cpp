#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "common/output_file.h"
#include "instrument/rest_shape.h"
#include "scene/instrument_library.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{
namespace fs = std::filesystem;
using namespace endovascular_sim;

constexpr double kSpacing = 0.5e-3;  // largest distance between points of a drawn shape [m]

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

/** CSV file with a header line. */
class Table
{
public:
  /** @throws InputError when the file cannot be opened */
  Table(const fs::path& file, const std::string& header) : file_(file), stream_(tools::openFile(file))
  {
    stream_.precision(9);
    stream_ << header << "\n";
  }

  std::ofstream& row() { return stream_; }

  void close()
  {
    stream_.close();
    tools::requireWritten(static_cast<bool>(stream_), file_);
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
  const auto beside = [&csv](const std::string& table)
  { return csv.parent_path() / (csv.stem().string() + "_" + table + ".csv"); };
  writeShafts(csv, all);
  if (any(all, [](const instrument::Instrument& i) { return !i.markers.empty(); }))
    writeMarkers(beside("markers"), all);
  if (any(all, [](const instrument::Instrument& i) { return i.balloon.has_value(); }))
    writeBalloons(beside("balloon"), all);
  if (any(all, [](const instrument::Instrument& i) { return i.stent.has_value(); }))
    writeStents(beside("stent"), all);
}

/** Draws the instruments with `plots instruments`. */
int draw(const fs::path& picture, const std::vector<Drawn>& all)
{
  const fs::path folder = fs::temp_directory_path() / ("instrument_shape_" + std::to_string(::getpid()));
  createFolder(folder.string());
  writeTables(folder / "shaft.csv", all);
  const bool drawn = tools::runPlots({"instruments", folder.string(), picture.string()});
  fs::remove_all(folder);
  return drawn ? 0 : 1;
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
  std::vector<std::string> warnings;
  for (const std::string& file : files)
  {
    all.push_back({fs::path(file).stem().string(), scene::loadInstrument(file, options.overrides, &warnings)});
    tools::printWarnings("instrument_shape", warnings);
  }
  return all;
}

int run(const Options& options)
{
  const std::vector<Drawn> all = readAll(options);
  if (options.out.extension() != ".csv")
    return draw(options.out, all);
  writeTables(options.out, all);
  return 0;
}

void addOptions(tools::CommandLine& line, Options& options)
{
  line.argument(
      "INSTRUMENT", options.instruments,
      "YAML file, or the name of one in config/instruments, e.g. catheter_5f_jl4; all: every one of that folder");
  line.option("--out", options.out, "FILE",
              ".png or .svg: the drawing. .csv: its data, with FILE_markers.csv, FILE_balloon.csv and FILE_stent.csv "
              "beside it for the instruments that have them")
      ->required()
      ->check(
          [](const std::string& name)
          {
            const std::string extension = fs::path(name).extension().string();
            const bool known = extension == ".png" || extension == ".svg" || extension == ".csv";
            return known ? "" : "requires a .png, .svg or .csv file";
          });
  line.overrides(options.overrides, "replaces a value in every instrument, e.g. --set tip.radius=0.005");
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "instrument_shape",
      "Draws instruments: the rest shape from two sides, diameter and bending stiffness along the "
      "shaft, radiopaque markers, the compliance chart of a balloon, the length of a stent.",
      "Exit code: 0 success; 1 an instrument was rejected or the drawing failed (the reason is on the "
      "error stream); 2 wrong arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return run(options); });
}
