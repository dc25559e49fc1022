#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/file/file_name.h"
#include "common/numerics/parallel_for.h"
#include "common/process/child_process.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "common/text/format.h"
#include "fluoroscopy/image/png_writer.h"
#include "image/volume_file.h"
#include "scene/mesh_trial.h"
#include "segmentation/lumen_centreline.h"
#include "segmentation/mesh/segmented_vessel.h"
#include "segmentation/segmentation_report.h"
#include "segmentation/view/ct_page.h"
#include "segmentation/view/straightened_view.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"
#include "vessel/centreline/centreline_file.h"
#include "vessel/io/mesh_reader.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

constexpr auto kName = "vessel_segment";

struct Options
{
  std::string images;
  std::vector<std::string> clicks;
  std::string out;
  std::string page;
  std::string modality;
  std::vector<std::string> open;
  std::vector<std::string> closed;
  int series = 0;
  double subtract = 0.0;
  double point_spread = 0.0;   // mm; 0: by modality
  double wall = -1.0;          // mm; < 0: by modality
  double max_distance = 2e-4;  // m
  double cut_back = 0.75;
  double memory = 4.0;  // GB
  int threads = 0;
  bool half_maximum = false;
  bool quiet = false;
};

/** Times of the stages on the error stream. */
class StageClock
{
public:
  explicit StageClock(bool quiet) : quiet_(quiet) {}

  void begin(const std::string& stage) const
  {
    if (!quiet_)
      std::fprintf(stderr, "%6.1f s  %s\n",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), stage.c_str());
  }

private:
  bool quiet_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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

/** Converts images by volume_import, which lies beside this program. */
void import(const Options& options, const std::string& volume)
{
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "volume_import";
  if (!std::filesystem::exists(program))
    throw InputError(options.images, "",
                     "is no .vol file, and volume_import is not built; install libinsighttoolkit5-dev and build again");
  std::vector<std::string> command = {program.string(), options.images, "--out",
                                      volume,           "--memory",     std::to_string(options.memory)};
  if (!options.modality.empty())
    command.insert(command.end(), {"--modality", options.modality});
  if (options.series > 0)
    command.insert(command.end(), {"--series", std::to_string(options.series)});
  if (options.subtract != 0.0)
    command.insert(command.end(), {"--subtract", std::to_string(options.subtract)});
  if (runProgram(command) != 0)
    throw InputError(options.images, "", "was rejected by volume_import for the reason above");
}

segmentation::Scan readScan(const Options& options, const std::string& stem, const StageClock& clock,
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
  settings.max_distance = options.max_distance;
  settings.cut_back = options.cut_back;
  settings.threads = options.threads;
  return settings;
}

void writeViews(const segmentation::Scan& scan, const std::vector<segmentation::LumenBranch>& branches,
                const std::string& stem)
{
  for (const segmentation::LumenBranch& branch : branches)
  {
    const segmentation::GreyPicture view = segmentation::straightenedView(scan, branch);
    fluoroscopy::writePng(stem + "_" + fileNameOf(branch.name) + ".png", view.width, view.height, view.pixels);
  }
}

/** Writes the page on which clicks are made. */
int writePage(const Options& options)
{
  const StageClock clock(options.quiet);
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

/** Files of a vessel under their final names, and under names for the checks of the simulator. */
struct VesselFiles
{
  std::string mesh;
  std::string centreline;
  std::string tried_mesh;
  std::string tried_centreline;

  explicit VesselFiles(const std::string& stem)
    : mesh(stem + ".obj"),
      centreline(stem + "_centreline.yaml"),
      tried_mesh(stem + ".part.obj"),
      tried_centreline(stem + ".part.yaml")
  {
  }
  VesselFiles(const VesselFiles&) = delete;
  VesselFiles& operator=(const VesselFiles&) = delete;
  ~VesselFiles()
  {
    std::error_code code;
    std::filesystem::remove(tried_mesh, code);
    std::filesystem::remove(tried_centreline, code);
  }

  /** Gives the files their final names, in place of those of an earlier vessel. */
  void keep() const
  {
    std::filesystem::rename(tried_mesh, mesh);
    std::filesystem::rename(tried_centreline, centreline);
  }

  /** Message with the final names. */
  std::string named(std::string message) const
  {
    for (const auto& [tried, name] : {std::pair(tried_mesh, mesh), std::pair(tried_centreline, centreline)})
      for (std::size_t at = message.find(tried); at != std::string::npos; at = message.find(tried, at + name.size()))
        message.replace(at, tried.size(), name);
    return message;
  }
};

/** Position [m] as an argument of --set, quoted for a shell. */
std::string positionArgument(const Eigen::Vector3d& position)
{
  return formatted("'[%.4f, %.4f, %.4f]'", position.x(), position.y(), position.z());
}

/** Error of a vessel that scenes would refuse. */
InputError notWritten(const std::string& stem, const std::string& reason)
{
  return InputError(
      stem + ".obj", "",
      "is not written, because no scene can use the vessel (" + reason + "); look at the straightened views " + stem +
          "_BRANCH.png, then move clicks, e.g. to the ends of a longer stretch, or leave an end closed by "
          "--closed");
}

/** Writes mesh and centreline if a scene can use them.
 *  @return arguments of `simulate` that use the vessel
 *  @throws InputError with the reason of the simulator; an earlier vessel stays */
std::string writeVessel(const segmentation::Scan& scan, const geometry::TriangleMesh& mesh,
                        const vessel::CentrelineTree& tree, const std::string& stem, std::vector<std::string>& warnings)
{
  const VesselFiles files(stem);
  vessel::writeObj(segmentation::toPatient(scan, mesh), files.tried_mesh);
  vessel::writeCentreline(segmentation::toPatient(scan, tree), std::filesystem::path(stem).filename().string(),
                          files.tried_centreline);
  scene::MeshTrial trial;
  try
  {
    trial = scene::tryMesh(std::filesystem::absolute(files.tried_mesh).string(),
                           std::filesystem::absolute(files.tried_centreline).string());
  }
  catch (const InputError& error)
  {
    throw notWritten(stem, files.named(error.what()));
  }
  for (const std::string& warning : trial.warnings)
    warnings.push_back(files.named(warning));
  files.keep();
  std::string arguments =
      "config/scenes/mesh.yaml --set vessel.mesh=" + std::filesystem::absolute(files.mesh).string() +
      " --set vessel.unit=1 --set vessel.centreline=" + std::filesystem::absolute(files.centreline).string();
  if (trial.entry)
    arguments += " --set entry.position=" + positionArgument(*trial.entry);
  return arguments;
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
    throw notWritten(stem, error.what());
  }
}

int segment(const Options& options)
{
  const StageClock clock(options.quiet);
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
  const std::string arguments = writeVessel(scan, vessel.mesh, vessel.centreline, stem, warnings);
  tools::writeFile(stem + "_report.json", segmentation::segmentationJson(scan, vessel.branches, warnings));
  clock.begin("done");
  tools::printWarnings(kName, warnings);
  const vessel::MeshReport& defects = vessel.report.before.defects;
  std::cout << segmentation::segmentationText(scan, vessel.branches) << vessel.mesh.triangles.size()
            << " triangles, genus " << defects.genus << ", open ends: " << vessel.open_ends << ", at most "
            << std::round(1e6 * vessel.report.result_to_input.largest) * 1e-3
            << " mm from the contours\nlook at the straightened views " << stem << "_BRANCH.png before use\nwrote "
            << options.out << ", " << stem << "_centreline.yaml, " << stem << "_report.json\n"
            << "to use the vessel: simulate " << arguments << "\n";
  return 0;
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
  line.repeated("--open", options.open, "WHICH",
                "ends that become open: all, largest, a count (the widest ends), x,y,z in metres (the nearest end; "
                "vessel_server prints it for a click in rviz), or a branch [all]");
  line.repeated("--closed", options.closed, "WHICH", "ends that stay closed, named likewise");
  line.quantity("--max-distance", options.max_distance, "M", quantities::kSurfaceDistance,
                "largest distance of the mesh from the contours [0.0002]");
  line.quantity("--cut-back", options.cut_back, "R", quantities::kScale,
                "distance of an open end from the last contour, in radii of the lumen [0.75]");
  line.option("--memory", options.memory, "GB", "largest need of memory [4]")->check(CLI::Range(0.1, 1000.0));
  line.option("--threads", options.threads, "N", "number of threads; the result does not depend on it [0: processors]")
      ->check(CLI::Range(0, 256));
  line.flag("--half-maximum", options.half_maximum, "edges half-way between lumen and wall, for comparison");
  line.flag("--quiet", options.quiet, "prints no stages");
  line.require(
      [&options]() -> std::string
      {
        if (options.page.empty())
          return options.clicks.empty() || options.out.empty() ? "--clicks and --out are required, or --page" : "";
        return options.clicks.empty() && options.out.empty() ? "" : "--page excludes --clicks and --out";
      });
  return line.run(argc, argv, [&options] { return options.page.empty() ? segment(options) : writePage(options); });
}
