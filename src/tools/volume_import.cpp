#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "common/error.h"
#include "common/process/child_process.h"
#include "image/import/image_reader.h"
#include "image/volume_file.h"
#include "tools/command_line.h"

namespace
{

using namespace endovascular_sim;

constexpr auto kName = "volume_import";
constexpr double kGigabyte = 1e9;
constexpr std::uint64_t kProgram = 512ULL << 20;  // address space of program and libraries [bytes]

struct Options
{
  std::string input;
  std::string output;
  std::string modality;
  std::vector<long> labels;
  int series = 0;
  double memory = 4.0;  // GB
  double time = 600.0;  // s
  double subtract = 0.0;
};

void print(const image::Volume& volume)
{
  const image::VolumeGrid& grid = volume.grid;
  const Eigen::Vector3d low = grid.bounds().min();
  const Eigen::Vector3d high = grid.bounds().max();
  std::printf("%d x %d x %d voxels of %.3f x %.3f x %.3f mm, %s, %.0f MB\n", grid.size.x(), grid.size.y(),
              grid.size.z(), 1e3 * grid.spacing.x(), 1e3 * grid.spacing.y(), 1e3 * grid.spacing.z(),
              volume.modality == image::Modality::kCt       ? "CT"
              : volume.modality == image::Modality::kLabels ? "labels"
                                                            : "no CT",
              2e-6 * static_cast<double>(grid.voxels()));
  const char* names[] = {"left", "back", "head"};
  for (int axis = 0; axis < 3; ++axis)
    std::printf("  towards the patient's %s: %.1f to %.1f mm\n", names[axis], 1e3 * low[axis], 1e3 * high[axis]);
}

/** Reads and writes, in the process with the limits. @return exit code */
int import(const Options& options)
{
  try
  {
    image::ImportOptions choices;
    choices.series = options.series;
    choices.subtract = options.subtract;
    choices.labels = options.labels;
    choices.memory = static_cast<std::uint64_t>(options.memory * kGigabyte);
    if (!options.modality.empty())
      choices.modality = options.modality == "ct" ? image::Modality::kCt : image::Modality::kOther;
    const image::Volume volume = image::readImages(options.input, choices);
    image::writeVolume(options.output, volume);
    print(volume);
    return 0;
  }
  catch (const InputError& error)
  {
    std::cerr << kName << ": " << error.what() << "\n";
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << kName << ": " << options.input
              << ": needs more memory than --memory permits; raise it, or export a part of the "
                 "volume\n";
  }
  catch (const std::exception& error)
  {
    std::cerr << kName << ": " << options.input << ": cannot be read: " << error.what()
              << "; export the images again\n";
  }
  return 1;
}

/** Imports in a process of its own: a damaged file can end it, but not this program. */
int importWithLimits(const Options& options)
{
  std::cout.flush();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0)
    throw InputError(options.input, "", "no process can be started; close other programs");
  if (child == 0)
  {
    endWithParent(parent);
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = static_cast<rlim_t>(options.memory * kGigabyte) + kProgram;
    setrlimit(RLIMIT_AS, &limit);
    const int code = import(options);
    std::fflush(stdout);
    _exit(code);
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.time);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0)
  {
    if (std::chrono::steady_clock::now() > end)
    {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      throw InputError(options.input, "",
                       "was not read within " + std::to_string(static_cast<int>(options.time)) +
                           " s; raise --time, or copy the images to a local disk");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (WIFSIGNALED(status))
    throw InputError(options.input, "",
                     "ended its reader by signal " + std::to_string(WTERMSIG(status)) +
                         ": a file is damaged, or --memory is too small; export the images again");
  return WEXITSTATUS(status);
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      kName,
      "Imports images of a patient: a folder with a DICOM series, or a file in NIfTI, NRRD or "
      "MetaImage. The result is a volume in the patient frame (x left, y back, z head). It holds no "
      "name, number or date of the patient.",
      "Exit code: 0 the volume was written; 1 the images were rejected, the reason is on the error "
      "stream; 2 wrong arguments.");
  line.argument("INPUT", options.input,
                "folder with a DICOM series, or file .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd");
  line.option("--out", options.output, "FILE", "file of the volume")->required();
  line.option("--series", options.series, "N", "series of the folder, from 1; default: the only one")
      ->check(CLI::Range(1, 100000));
  line.option("--modality", options.modality, "KIND",
              "ct: values are Hounsfield units; other; default: that of the file")
      ->check(CLI::IsMember({"ct", "other"}));
  line.option("--subtract", options.subtract, "N", "number that is subtracted from all values [0]")
      ->check(CLI::Range(-1e6, 1e6));
  line.option("--label", options.labels, "N",
              "label of a label map, which is reduced to the box around its chosen labels; may be repeated. "
              "vessel_segment makes vessels of them")
      ->allow_extra_args(false);
  line.option("--memory", options.memory, "GB", "largest need of memory [4]")->check(CLI::Range(0.1, 1000.0));
  line.option("--time", options.time, "S", "longest time of reading [600]")->check(CLI::Range(1.0, 1e6));
  return line.run(argc, argv, [&options] { return importWithLimits(options); });
}
