#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/numerics/parallel_for.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "fluoroscopy/image/png_writer.h"
#include "image/volume_file.h"
#include "segmentation/mesh/segmented_vessel.h"
#include "segmentation/other_lumens.h"
#include "segmentation/segmentation_report.h"
#include "segmentation/view/ct_page.h"
#include "segmentation/view/straightened_view.h"
#include "tools/command_line.h"
#include "tools/import_images.h"
#include "tools/label_command.h"
#include "tools/stage_clock.h"
#include "tools/tool_output.h"
#include "tools/vessel_files.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

constexpr auto kName = "vessel_segment";
struct Options
{
  std::string images;
  std::vector<std::string> clicks;
  std::vector<std::string> labels;
  std::string names;
  std::string out;
  std::string page;
  std::string modality;
  std::vector<std::string> open;
  std::vector<std::string> closed;
  int series = 0;
  double subtract = 0.0;
  double point_spread = 0.0;  // mm; 0: by modality
  double wall = -1.0;         // mm; < 0: by modality
  double max_distance = 0.0;  // m; 0: by kind of the images
  double cut_back = 0.75;
  double memory = 4.0;  // GB
  int threads = 0;
  bool half_maximum = false;
  bool quiet = false;
};

bool isVolume(const std::string& path)
{
  return std::filesystem::path(path).extension() == ".vol";
}

/** Bytes that the segmentation of a volume needs: its voxels twice, the coarse grids of the paths, the surface. */
double memoryFor(const std::string& volume)
{
  std::error_code code;
  const auto bytes = static_cast<double>(std::filesystem::file_size(volume, code));
  return code ? 0.0 : 2.6 * bytes + 3e8;
}

/** Converts images by volume_import. */
void import(const Options& options, const std::string& volume)
{
  std::vector<std::string> choices = {"--memory", std::to_string(options.memory)};
  if (!options.modality.empty())
    choices.insert(choices.end(), {"--modality", options.modality});
  if (options.series > 0)
    choices.insert(choices.end(), {"--series", std::to_string(options.series)});
  if (options.subtract != 0.0)
    choices.insert(choices.end(), {"--subtract", std::to_string(options.subtract)});
  tools::importImages(options.images, volume, choices);
}

segmentation::Scan readScan(const Options& options, const std::string& stem, const tools::StageClock& clock,
                            std::vector<std::string>& warnings)
{
  std::string volume = options.images;
  if (!isVolume(volume))
  {
    volume = stem + ".vol";
    clock.begin("importing the images");
    import(options, volume);
  }
  if (memoryFor(volume) > 1e9 * options.memory)
    throw InputError(volume, "",
                     "needs about " + std::to_string(memoryFor(volume) * 1e-9).substr(0, 4) +
                         " GB; raise --memory, or export a part of the images");
  clock.begin("reading the volume");
  image::Volume read = image::readVolume(volume);
  if (!options.modality.empty())
    read.modality = options.modality == "ct" ? image::Modality::kCt : image::Modality::kOther;
  const double coarsest = read.grid.spacing.maxCoeff();
  if (read.modality == image::Modality::kCt && coarsest > 1.5e-3 + 1e-9)
    warnings.push_back("slices are " + std::to_string(1e3 * coarsest).substr(0, 4) +
                       " mm apart: vessels below 4 mm are unreliable; reconstruct slices of 1 mm or less");
  return segmentation::Scan(std::move(read));
}

segmentation::VesselSettings settingsOf(const Options& options, const segmentation::Scan& scan)
{
  segmentation::VesselSettings settings;
  settings.edge = segmentation::edgeSettings(scan.modality(), scan.spacing());
  if (options.point_spread > 0.0)
    settings.edge.point_spread = 1e-3 * options.point_spread;
  if (options.wall >= 0.0)
    settings.edge.wall = 1e-3 * options.wall;
  settings.edge.half_maximum = options.half_maximum;
  if (!options.open.empty())
    settings.open = options.open;
  settings.closed = options.closed;
  if (options.max_distance > 0.0)
    settings.max_distance = options.max_distance;
  settings.cut_back = options.cut_back;
  settings.threads = options.threads;
  return settings;
}

void writeViews(const segmentation::Scan& scan, const std::vector<segmentation::LumenBranch>& branches,
                const std::string& stem)
{
  for (std::size_t b = 0; b < branches.size(); ++b)
  {
    const segmentation::ColourPicture view =
        segmentation::straightenedView(scan, branches[b], segmentation::otherLumens(branches, b));
    fluoroscopy::writeColourPng(stem + "_" + branches[b].name + ".png", view.width, view.height, view.pixels);
  }
}

/** Writes the page on which clicks are made. */
int writePage(const Options& options)
{
  const tools::StageClock clock(options.quiet);
  std::vector<std::string> warnings;
  const std::filesystem::path page(options.page);
  tools::requireWritable(options.page);
  const segmentation::Scan scan = readScan(options, (page.parent_path() / page.stem()).string(), clock, warnings);
  clock.begin("writing the page");
  tools::writeFile(options.page, segmentation::ctPage(scan));
  tools::printWarnings(kName, warnings);
  std::cout << "wrote " << options.page
            << ": open it in a browser, save clicks.yaml there, and give it with --clicks\n";
  return 0;
}

/** Remedy of a vessel that scenes refuse. */
std::string remedyOf(const std::string& stem)
{
  return "look at the straightened views " + stem +
         "_BRANCH.png, then move clicks, e.g. to the ends of a longer stretch, or leave an end closed by --closed";
}

segmentation::SegmentedVessel vesselOf(const Options& options, const segmentation::Scan& scan,
                                       const segmentation::ClickSet& clicks, const std::string& stem,
                                       const segmentation::VesselObserver& observer)
{
  try
  {
    return segmentation::segmentVessel(scan, clicks, settingsOf(options, scan), options.images, observer);
  }
  catch (const segmentation::UnusableSurface& error)
  {
    throw tools::notWritten(stem, error.what(), remedyOf(stem));
  }
}

int segment(const Options& options)
{
  const tools::StageClock clock(options.quiet);
  const std::filesystem::path out(options.out);
  const std::string stem = (out.parent_path() / out.stem()).string();
  std::vector<std::string> warnings;
  const segmentation::ClickSet clicks = segmentation::readClicks(options.clicks);
  tools::requireWritable(options.out);
  const segmentation::Scan scan = readScan(options, stem, clock, warnings);
  segmentation::VesselObserver observer;
  observer.stage = [&clock](const std::string& stage) { clock.begin(stage); };
  observer.segmented = [&](const std::vector<segmentation::LumenBranch>& branches)
  {
    clock.begin("drawing the straightened views");
    writeViews(scan, branches, stem);
  };
  const segmentation::SegmentedVessel vessel = vesselOf(options, scan, clicks, stem, observer);
  warnings.insert(warnings.end(), vessel.warnings.begin(), vessel.warnings.end());
  clock.begin("checking the vessel as scenes do");
  const std::string arguments =
      tools::writeVessel(scan, vessel.mesh, vessel.centreline, stem, remedyOf(stem), warnings);
  tools::writeFile(stem + "_report.json", segmentation::segmentationJson(scan, vessel.branches, warnings));
  clock.begin("done");
  tools::printWarnings(kName, warnings);
  const vessel::MeshReport& defects = vessel.report.before.defects;
  std::cout << segmentation::segmentationText(scan, vessel.branches, warnings) << vessel.mesh.triangles.size()
            << " triangles, genus " << defects.genus << ", open ends: " << vessel.open_ends << ", at most "
            << std::round(1e6 * vessel.report.result_to_input.largest) * 1e-3
            << " mm from the contours\nlook at the straightened views " << stem << "_BRANCH.png before use\nwrote "
            << options.out << ", " << stem << "_centreline.yaml, " << stem << "_report.json\n"
            << "to use the vessel: rosrun endovascular_sim simulate " << arguments << "\n";
  return 0;
}

/** Makes a vessel of a label map. */
int segmentLabels(const Options& options)
{
  tools::LabelCommand command;
  command.map = options.images;
  command.labels = options.labels;
  command.names = options.names;
  command.clicks = options.clicks;
  command.out = options.out;
  command.settings.open = options.open;
  command.settings.closed = options.closed;
  command.settings.max_distance = options.max_distance;
  command.settings.cut_back = options.cut_back;
  command.series = options.series;
  command.memory = options.memory;
  command.quiet = options.quiet;
  return tools::segmentLabels(command);
}

int run(const Options& options)
{
  if (!options.labels.empty())
    return segmentLabels(options);
  return options.page.empty() ? segment(options) : writePage(options);
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(kName,
                          "Segments the vessels of a CT or MR angiogram along a few clicks: two per branch. Makes the "
                          "mesh of a vessel for scenes, "
                          "its centreline, a report, and a straightened view of every branch with its contour.",
                          "Exit code: 0 the vessel was written; 1 images or clicks were rejected, the reason is on the "
                          "error stream; 2 wrong "
                          "arguments.");
  line.argument(
      "IMAGES", options.images,
      "volume of volume_import (.vol); or a folder with a DICOM series, a NIfTI, NRRD or MetaImage file, which "
      "volume_import converts first");
  line.repeated("--clicks", options.clicks, "FILE",
                "clicks into the lumen: .yaml, or markups of 3D Slicer (.mrk.json, .fcsv)");
  line.repeated("--label", options.labels, "N",
                "IMAGES is a label map or a mask: makes a vessel of the label with this number, or with this name of "
                "--names. --clicks is optional then: a click opens the end beside it");
  line.option("--names", options.names, "TABLE",
              "names of labels: .yaml or .json (number: name), .csv, or a colour table of 3D Slicer (.ctbl)");
  line.option(
          "--out", options.out, "OUT.obj",
          "the vessel in metres, in the patient frame; beside it OUT_centreline.yaml, OUT_report.json, OUT_BRANCH.png, "
          "and OUT.vol if the images are converted")
      ->check([](const std::string& name)
              { return std::filesystem::path(name).extension() == ".obj" ? "" : "requires a name that ends in .obj"; });
  line.option("--page", options.page, "PAGE.html",
              "writes a page for the browser, on which clicks are made; in place of --clicks and --out");
  line.option("--modality", options.modality, "KIND",
              "ct: values are Hounsfield units; other; default: that of the file")
      ->check(CLI::IsMember({"ct", "other"}));
  line.option("--series", options.series, "N", "series of a DICOM folder, from 1; default: the only one")
      ->check(CLI::Range(1, 100000));
  line.option("--subtract", options.subtract, "N", "number that volume_import subtracts from all values [0]")
      ->check(CLI::Range(-1e6, 1e6));
  line.option("--point-spread", options.point_spread, "MM",
              "standard deviation of the scanner's point spread [CT 0.3 mm; else 0.55 voxels]; 20 % suffice")
      ->check(CLI::Range(0.01, 10.0));
  line.option("--wall", options.wall, "MM", "thickness of the vessel wall [CT 0.8 mm; else 0]")
      ->check(CLI::Range(0.0, 5.0));
  line.repeated(
      "--open", options.open, "WHICH",
      "ends that become open: all, largest, a count (the widest ends), x,y,z in metres (the nearest end; "
      "vessel_server prints it for a click in rviz), or a branch [all; of a label those at the border of the image]");
  line.repeated("--closed", options.closed, "WHICH", "ends that stay closed, named likewise");
  line.quantity("--max-distance", options.max_distance, "M", quantities::kSurfaceDistance,
                "largest distance of the mesh from the contours [0.0002; of a label 0.4 voxels]");
  line.quantity(
      "--cut-back", options.cut_back, "R", quantities::kScale,
      "distance of an open end from the last contour, or from the tip of a label, in radii of the lumen [0.75]");
  line.option("--memory", options.memory, "GB", "largest need of memory [4]")->check(CLI::Range(0.1, 1000.0));
  line.option("--threads", options.threads, "N", "number of threads; the result does not depend on it [0: processors]")
      ->check(CLI::Range(0, 256));
  line.flag("--half-maximum", options.half_maximum, "edges half-way between lumen and wall, for comparison");
  line.flag("--quiet", options.quiet, "prints no stages");
  line.require(
      [&options]() -> std::string
      {
        if (!options.names.empty() && options.labels.empty())
          return "--names requires --label";
        if (!options.labels.empty())
          return options.page.empty() && !options.out.empty() ? "" : "--label requires --out, and excludes --page";
        if (options.page.empty())
        {
          if (options.out.empty())
            return "--out is required, or --page";
          return options.clicks.empty() ? "give --clicks for images, or --label N for a label map" : "";
        }
        return options.clicks.empty() && options.out.empty() ? "" : "--page excludes --clicks and --out";
      });
  return line.run(argc, argv, [&options] { return run(options); });
}
