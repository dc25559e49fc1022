#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>

#include "benchmark/studies/accuracy.h"
#include "benchmark/studies/contact_study.h"
#include "benchmark/studies/hand_force_study.h"
#include "benchmark/studies/sampling_sections.h"
#include "benchmark/studies/speed.h"
#include "benchmark/studies/stability.h"
#include "benchmark/studies/work_precision.h"
#include "common/error.h"

namespace
{

std::atomic<std::uint64_t> allocation_count{0};

}  // namespace

// Counts what the program allocates, for the speed study.
void* operator new(std::size_t size)
{
  ++allocation_count;
  if (void* memory = std::malloc(size))
    return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept
{
  std::free(memory);
}

namespace
{

using namespace endovascular_sim;             // NOLINT: a program's main file
using namespace endovascular_sim::benchmark;  // NOLINT

constexpr auto kUsage = R"(Measures the rod: error, stability and time. Needs no ROS master.

usage: benchmark STUDY --out DIR [--quick] [--vessel-mesh FILE]

  STUDY               accuracy        errors against reference values, with the observed order
                      work-precision  error against run time
                      stability       hard cases: good, refused or bad
                      speed           time per step, phase by phase, over the number of nodes
                      contact         detection: bounding volumes, time per step, growth with the triangles
                      hand_force      force at the hand: charts, nodes, noise
                      sampling        adaptive against uniform sampling
                      all             all of these
  --out DIR           writes a CSV per table, plots and VALIDATION.md there; made when it is missing
  --quick             fewer and smaller cases: a few minutes
  --vessel-mesh FILE  aortic_arch_tree.obj [mm]; default: looked for in ENDOVASCULAR_DATA_DIR
  --help              prints this

exit code: 0 done, 1 a file cannot be written or a study failed, 2 wrong use
)";

struct Study
{
  const char* name;
  const char* heading;
  std::vector<Section> (*run)(const StudyOptions&, const Progress&);
};

std::vector<Section> speed(const StudyOptions& options, const Progress& progress)
{
  return speedStudy(options, progress, [] { return allocation_count.load(); });
}

constexpr Study kStudies[] = {{"accuracy", "Accuracy", accuracyStudy},
                              {"work-precision", "Work and precision", workPrecisionStudy},
                              {"speed", "Speed", speed},
                              {"contact", "Contact", contactStudy},
                              {"hand_force", "Force at the hand", handForceStudy},
                              {"sampling", "Adaptive sampling", samplingSections},
                              {"stability", "Stability", stabilityStudy}};

struct Options
{
  std::string study;
  std::string out;
  StudyOptions study_options;
};

int wrongUse(const std::string& reason)
{
  std::cerr << "benchmark: " << reason << "\n\n" << kUsage;
  return 2;
}

bool isKnown(const std::string& name)
{
  bool known = name == "all";
  for (const Study& study : kStudies)
    known = known || name == study.name;
  return known;
}

/** @return −1 to go on, else the exit code */
int parse(int argc, char** argv, Options& options)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--help" || word == "-h")
    {
      std::cout << kUsage;
      return 0;
    }
    if (word == "--quick")
      options.study_options.quick = true;
    else if (word == "--out" && has_value)
      options.out = argv[++i];
    else if (word == "--vessel-mesh" && has_value)
      options.study_options.vessel_mesh = argv[++i];
    else if (options.study.empty() && isKnown(word))
      options.study = word;
    else
      return wrongUse("cannot use '" + word + "'");
  }
  if (options.study.empty() || options.out.empty())
    return wrongUse("a study and --out are needed");
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  const std::filesystem::path mesh = std::filesystem::path(folder ? folder : "") / "aortic_arch_tree.obj";
  std::string& chosen = options.study_options.vessel_mesh;
  if (chosen.empty() && folder && std::filesystem::exists(mesh))
    chosen = mesh.string();
  if (!chosen.empty() && !std::filesystem::exists(chosen))
    return wrongUse("there is no file " + chosen);
  if (!chosen.empty())
    chosen = std::filesystem::absolute(chosen).string();
  return -1;
}

void drawProgress(double done, const std::string& what)
{
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(done * kWidth);
  std::fprintf(stderr, "\r\033[K[%s%s] %3.0f %%  %.90s", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), 100.0 * done, what.c_str());
}

void writeFile(const std::filesystem::path& path, const std::string& text)
{
  std::ofstream stream(path);
  if (!(stream << text) || !stream.flush())
    throw InputError(path.string(), "", "cannot be written; check the folder's permissions and the disk's free space");
}

std::string markdown(const Section& section)
{
  std::string text = "### " + section.heading + "\n\n" + section.text + "\n\n";
  if (!section.plot.empty() && section.table.rows() > 0)
    text += "![" + section.heading + "](images/validation/" + section.plot + ")\n\n";
  return section.table.rows() > 0 && !section.only_csv ? text + section.table.markdown() + "\n" : text;
}

constexpr auto kLimits = R"(## Limits

- `kkt` and `paper` are of second order in space: 100 nodes give 1e-4 L on strongly bent wires. `mixed` is of fourth order
  for nodal and distributed loads, rest curvature, twist and joints of sections at nodes, in the plane and in space: on a
  45° arc bent out of its plane its error at 25 nodes is that of `kkt` at several thousand.
- `mixed` has contact by its nodes: chords touch the wall, not arcs, so a bent wall needs edges as short as those of `kkt`
  and each costs three times as much; it keeps its nodes, because an edge of it is accurate at several times the length
  that the wall asks for. So `kkt` stays the default; `mixed` wins wherever loads act at nodes and shapes are smooth.
- Adaptive sampling: `kkt` hides a change of nodes from the hand, `paper` does not.
- Backward Euler is of first order in time and takes energy from fast modes. Twist is quasi-static.
- `paper` has no trust region: a wall stops it only by depth, and at steps of 1 ms a stiff wire leaves through it. Its
  friction falls short where a node is slow.
- A wire of which every node is moved at random by its edge's length, or that is folded back onto itself to less than 6°,
  is held where it is and the step refused.
- On facetted meshes a stiff tip snaps over ridges; when it does depends on every detail. Runs are compared before the
  first bifurcation, or as ensembles.
- Self-contact of the wire is out of scope.
)";

void plot(const std::filesystem::path& out)
{
  const std::filesystem::path script =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plot_benchmark.py";
  const std::string command = "/usr/bin/python3 '" + script.string() + "' '" + out.string() + "' >/dev/null";
  if (std::system(command.c_str()) != 0)
    std::cerr << "benchmark: the plots could not be drawn (" << command << ")\n";
}

void run(const Options& options)
{
  const std::filesystem::path out = options.out;
  std::filesystem::create_directories(out / "images" / "validation");
  const bool progress = isatty(STDERR_FILENO);
  std::string report = "# Validation\n\nWritten by `rosrun endovascular_sim benchmark " + options.study +
                       (options.study_options.quick ? " --quick" : "") +
                       " --out DIR`. Times are medians on one core of the machine that ran it; read ratios.\n\n";
  for (const Study& study : kStudies)
  {
    if (options.study != "all" && options.study != study.name)
      continue;
    std::cerr << study.heading << "\n";
    report += std::string("## ") + study.heading + "\n\n";
    const Progress show = [progress](double done, const std::string& what)
    {
      if (progress)
        drawProgress(done, what);
    };
    for (const Section& section : study.run(options.study_options, show))
    {
      writeFile(out / (section.name + ".csv"), section.table.csv());
      report += markdown(section);
    }
    if (progress)
      std::fputc('\n', stderr);
    // After every study, so that what was measured is there should a later one fail.
    writeFile(out / "VALIDATION.md", report);
  }
  writeFile(out / "VALIDATION.md", report + kLimits);
  plot(out);
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  const int code = parse(argc, argv, options);
  if (code >= 0)
    return code;
  try
  {
    run(options);
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "benchmark: " << error.what() << "\n";
    return 1;
  }
}
