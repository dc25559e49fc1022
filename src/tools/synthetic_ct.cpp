#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/progress.h"
#include "image/volume_file.h"
#include "phantom/diseased_vessel.h"
#include "phantom/phantom.h"
#include "phantom/true_clicks.h"
#include "scene/file_search.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"
#include "vessel/anatomy/anatomy.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

struct Options
{
  std::string out;
  std::string anatomy;
  std::string view = "heart";
  bool magnetic = false;
  double spacing = 0.0;        // mm
  double point_spread = -1.0;  // mm
  double noise = -1.0;
  double wall = 0.6;  // mm
  int seed = 1;
  int threads = 0;
  std::string clicks;
  std::vector<std::string> branches;
  std::string disease;
  double degree = std::numeric_limits<double>::quiet_NaN();
  bool quiet = false;
};

/** Field of view in the frame of config/anatomies/plain.yaml [mm]. */
struct View
{
  Eigen::Vector3d low, high;
  double spacing;
};

const std::map<std::string, View> kViews = {
    {"heart", {{-48, -100, 92}, {90, 46, 228}, 0.45}},
    {"abdomen", {{-95, -60, -150}, {95, 80, 110}, 0.8}},
    {"torso", {{-190, -140, -230}, {190, 140, 400}, 1.0}},
};

/** Box around the vessels with a margin of 10 mm. */
View fittingView(const vessel::Anatomy& anatomy)
{
  const Eigen::AlignedBox3d box = vessel::ImplicitVessel(anatomy, vessel::sampleChains(anatomy)).bounds();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(10.0);
  return {1e3 * box.min() - margin, 1e3 * box.max() + margin, 0.5};
}

phantom::PhantomSettings settingsOf(const Options& options, const vessel::Anatomy& anatomy)
{
  const View view = options.view == "fit" ? fittingView(anatomy) : kViews.at(options.view);
  phantom::PhantomSettings settings;
  Eigen::Vector3d spacing = Eigen::Vector3d::Constant(options.spacing > 0.0 ? options.spacing : view.spacing);
  if (options.magnetic)
  {
    settings.modality = image::Modality::kOther;
    settings.noise = 40.0;
    settings.point_spread = 6e-4;
    if (options.spacing <= 0.0)
      spacing = {0.88, 0.88, 1.5};
  }
  settings.grid = phantom::gridOfBox(1e-3 * view.low, 1e-3 * view.high, 1e-3 * spacing);
  if (options.noise >= 0.0)
    settings.noise = options.noise;
  if (options.point_spread >= 0.0)
    settings.point_spread = 1e-3 * options.point_spread;
  settings.wall_thickness = 1e-3 * options.wall;
  settings.seed = static_cast<std::uint64_t>(options.seed);
  settings.threads = options.threads;
  return settings;
}

void writeClicks(const Options& options, const std::vector<phantom::BranchClicks>& branches)
{
  std::ofstream out = tools::openFile(options.clicks);
  out << "# Simulated clicks into " << options.out << " [mm].\nframe: LPS\nunit: 0.001\nbranches:\n";
  for (const phantom::BranchClicks& branch : branches)
  {
    out << "  - name: " << branch.name << "\n    clicks: [";
    for (std::size_t k = 0; k < branch.points.size(); ++k)
    {
      char text[100];
      const Eigen::Vector3d p = 1e3 * branch.points[k];
      std::snprintf(text, sizeof text, "%s[%.2f, %.2f, %.2f]", k > 0 ? ", " : "", p.x(), p.y(), p.z());
      out << text;
    }
    out << "]\n";
  }
  tools::requireWritten(static_cast<bool>(out.flush()), options.clicks);
}

void write(const Options& options, const image::Volume& volume)
{
  image::writeVolume(options.out, volume);
  const image::VolumeGrid& grid = volume.grid;
  std::printf("%d x %d x %d voxels of %.3f x %.3f x %.3f mm, %.0f MB\n", grid.size.x(), grid.size.y(), grid.size.z(),
              1e3 * grid.spacing.x(), 1e3 * grid.spacing.y(), 1e3 * grid.spacing.z(),
              2e-6 * static_cast<double>(grid.voxels()));
}

int make(const Options& options)
{
  const std::string file = options.anatomy.empty() ? scene::configFolder() + "/anatomies/plain.yaml" : options.anatomy;
  const vessel::Anatomy anatomy = vessel::readAnatomy(file);
  tools::printWarnings("synthetic_ct", anatomy.warnings);
  const phantom::PhantomSettings settings = settingsOf(options, anatomy);
  if (!options.clicks.empty())
    writeClicks(options, phantom::trueClicks(anatomy, options.branches, settings.grid.bounds(), settings.seed));
  tools::requireWritable(options.out);
  const image::Volume volume =
      phantom::makePhantom(anatomy, settings, options.quiet ? ProgressReport() : progressOnErrorStream());
  write(options, volume);
  return 0;
}

int makeDisease(const Options& options)
{
  const std::unique_ptr<phantom::DiseasedVessel> vessel = phantom::diseasedVessel(options.disease, options.degree);
  phantom::PhantomSettings settings = vessel->usualImage();
  if (options.spacing > 0.0)
    settings.grid = phantom::gridOfBox(-vessel->halfExtent(), vessel->halfExtent(),
                                       Eigen::Vector3d::Constant(1e-3 * options.spacing));
  if (options.noise >= 0.0)
    settings.noise = options.noise;
  if (options.point_spread >= 0.0)
    settings.point_spread = 1e-3 * options.point_spread;
  settings.seed = static_cast<std::uint64_t>(options.seed);
  settings.threads = options.threads;
  if (!options.clicks.empty())
    writeClicks(options, {{"vessel", vessel->clicks()}});
  tools::requireWritable(options.out);
  write(options, phantom::imageOf(*vessel, settings, options.quiet ? ProgressReport() : progressOnErrorStream()));
  return 0;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "synthetic_ct",
      "Makes a CT or MR angiogram of a generated anatomy, whose lumen is known exactly: wall, "
      "calcium, and the body of X-ray images around the vessels, point spread and correlated noise. The result is a "
      "volume like "
      "those of volume_import, in the patient frame of the anatomy.",
      "Exit code: 0 the volume was written; 1 an input was rejected, the reason is on the error stream; 2 wrong "
      "arguments.");
  line.option("--out", options.out, "FILE", "file of the volume")->required();
  line.option("--anatomy", options.anatomy, "FILE", "anatomy file [config/anatomies/plain.yaml]")
      ->check(CLI::ExistingFile);
  line.option("--view", options.view, "VIEW",
              "field of view: heart (0.45 mm), abdomen (0.8 mm), torso (1 mm), fit: all vessels (0.5 mm) [heart]")
      ->check(CLI::IsMember({"heart", "abdomen", "torso", "fit"}));
  line.flag("--mr", options.magnetic,
            "MR angiogram: voxels of 0.88 x 0.88 x 1.5 mm, a signal that falls along the aorta");
  line.option("--spacing", options.spacing, "MM", "edge of a voxel [mm]; default: that of the field of view")
      ->check(CLI::Range(0.1, 10.0));
  line.option("--point-spread", options.point_spread, "MM",
              "standard deviation of the Gaussian point spread [0.3 mm; MR 0.6 mm]")
      ->check(CLI::Range(0.0, 10.0));
  line.option("--noise", options.noise, "VALUE", "standard deviation of the noise [25 HU; MR 40]")
      ->check(CLI::Range(0.0, 1000.0));
  line.option("--wall", options.wall, "MM", "thickness of the vessels' wall [0.6 mm]")->check(CLI::Range(0.0, 5.0));
  line.option("--seed", options.seed, "N", "seed of the noise and of the simulated clicks [1]")
      ->check(CLI::Range(0, 1000000000));
  line.option("--threads", options.threads, "N", "number of threads; the result does not depend on it [0: processors]")
      ->check(CLI::Range(0, 256));
  line.option("--clicks", options.clicks, "FILE.yaml",
              "also writes two simulated clicks per branch, for vessel_segment");
  line.repeated("--branch", options.branches, "NAME",
                "branch of the simulated clicks; default: all in the field of view");
  line.option("--disease", options.disease, "NAME",
              "diseased vessel in place of the anatomy: aneurysm, stenosis, dim_lumen (MR), bone (beside the wall), "
              "dissection, crescent (with a flap that bulges)")
      ->check(CLI::IsMember(phantom::diseaseNames()));
  line.option("--degree", options.degree, "VALUE",
              "of the disease: largest diameter [0.06 m], share of the diameter that is missing [0.8], darkest over "
              "brightest signal [0.35], gap before the bone [0.0002 m], distance of the flap from the axis in radii "
              "[-0.1]")
      ->check(CLI::Range(-1.0, 1.0));
  line.flag("--quiet", options.quiet, "prints no progress");
  return line.run(argc, argv, [&options] { return options.disease.empty() ? make(options) : makeDisease(options); });
}
