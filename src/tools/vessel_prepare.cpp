#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "common/error.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/centreline/centreline_file.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/prepare/prepare.h"
#include "vessel/repair/mesh_check.h"

namespace
{

using endovascular_sim::InputError;
namespace geometry = endovascular_sim::geometry;
namespace vessel = endovascular_sim::vessel;

constexpr auto kUsage =
    R"(Makes a vessel that scenes can use out of a mesh that they refuse: pieces that overlap, holes,
non-manifold edges, faces turned either way, coarse facets.

usage: vessel_prepare IN --unit METRES --out OUT.obj [options]

  IN                    OBJ, STL or PLY file
  --unit METRES         metres per unit of IN: 0.001 for millimetres, 1 for metres
  --out OUT.obj         the vessel, in metres (vessel.unit: 1 in a scene); beside it OUT_report.json, and
                        OUT_centreline.yaml: the centreline with diameters, as an anatomy file

  --max-distance M      largest distance of the result's wall from the input's, both ways [0.0002]
  --voxel M             edge of the grid's cells [2/3 of max-distance]; walls between lumens below two of them may be lost
  --bridge M            joins loose pieces that are closer than this to the vessel by a tube of their own width [0]
  --join ANATOMY.yaml   unites the vessel with a generated one (an anatomy file, in the axes of IN) that overlaps it, e.g.
                        the vessels beyond a cut end; may be repeated
  --plug X,Y,Z,R        closes the lumen inside of a wall with a thickness by a lid through this place, before an
                        opening; the wall is nearer than R all around [m]; may be repeated. When all openings of a
                        lumen are closed it counts as the inside, and the inner wall goes
  --hollow              the inner wall stays instead and the outer one goes: the lumen is the largest hollow
  --smooth              takes the edges of coarse facets out, within max-distance
  --smoothing-rounds N  [30]
  --facets-around N     of the result, around every lumen [24]
  --longest-facet M     of the result [0.0025]

  --open WHICH          leaves an end open: all, largest, a count (so many of the widest), x,y,z in metres (the end
                        nearest to it), or a branch's name from the report; may be repeated. Default: all ends are closed.
                        A scene closes flat open ends by itself when it reads the mesh.
  --cut-back R          how far before the tip of an open end the cut is, in radii of the lumen [1]
  --quiet               prints the report only
  --help                prints this

exit code: 0 done and within max-distance, 1 refused (the reason goes to the error stream), 2 wrong use, 3 done, but
somewhere beyond max-distance (the report says where)
)";

int wrongUse(const std::string& reason)
{
  std::cerr << "vessel_prepare: " << reason << "\n" << kUsage;
  return 2;
}

struct Arguments
{
  std::string in;
  std::string out;
  std::vector<std::string> joins;  ///< anatomy files
  double unit = 0.0;
  bool quiet = false;
  bool help = false;
  vessel::PrepareOptions options;
};

double numberOf(const std::string& option, const std::string& text)
{
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    throw std::invalid_argument(option + " needs a number, not \"" + text + "\"");
  return value;
}

vessel::Plug plugOf(const std::string& text)
{
  vessel::Plug plug;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf%c", &plug.centre.x(), &plug.centre.y(), &plug.centre.z(), &plug.radius,
                  &rest) != 4)
    throw std::invalid_argument("--plug needs x,y,z,radius in metres, not \"" + text + "\"");
  return plug;
}

int countOf(const std::string& option, const std::string& text)
{
  const double value = numberOf(option, text);
  if (!(value >= 0.0 && value <= 1e6) || value != static_cast<int>(value))
    throw std::invalid_argument(option + " needs a count, not \"" + text + "\"");
  return static_cast<int>(value);
}

/** @throws std::invalid_argument with what is wrong */
Arguments parse(const std::vector<std::string>& words)
{
  Arguments a;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    const std::string& word = words[i];
    const auto value = [&]() -> const std::string&
    {
      if (i + 1 >= words.size())
        throw std::invalid_argument(word + " needs a value");
      return words[++i];
    };
    const auto number = [&] { return numberOf(word, value()); };
    const auto count = [&] { return countOf(word, value()); };
    if (word == "--help" || word == "-h")
      a.help = true;
    else if (word == "--quiet")
      a.quiet = true;
    else if (word == "--hollow")
      a.options.hollow = true;
    else if (word == "--smooth")
      a.options.smooth = true;
    else if (word == "--unit")
      a.unit = number();
    else if (word == "--out")
      a.out = value();
    else if (word == "--max-distance")
      a.options.max_distance = number();
    else if (word == "--voxel")
      a.options.voxel = number();
    else if (word == "--bridge")
      a.options.bridge = number();
    else if (word == "--join")
      a.joins.push_back(value());
    else if (word == "--plug")
      a.options.plugs.push_back(plugOf(value()));
    else if (word == "--smoothing-rounds")
      a.options.smoothing_rounds = count();
    else if (word == "--facets-around")
      a.options.facets_around = count();
    else if (word == "--longest-facet")
      a.options.longest_facet = number();
    else if (word == "--cut-back")
      a.options.cut_back = number();
    else if (word == "--open")
      a.options.open.push_back(value());
    else if (word.rfind("--", 0) == 0)
      throw std::invalid_argument("unknown option " + word);
    else if (a.in.empty())
      a.in = word;
    else
      throw std::invalid_argument("one mesh at a time, not also " + word);
  }
  if (a.help)
    return a;
  if (a.in.empty())
    throw std::invalid_argument("needs a mesh file");
  if (a.out.empty() || std::filesystem::path(a.out).extension() != ".obj")
    throw std::invalid_argument("needs --out with a name that ends in .obj");
  if (!(a.unit > 0.0))
    throw std::invalid_argument("needs --unit: 0.001 for a mesh in millimetres, 1 for metres");
  return a;
}

void writeText(const std::string& text, const std::string& path)
{
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out)
    throw InputError(path, "", "cannot be written; give --out in an existing folder that can be written");
}

int prepare(const Arguments& a)
{
  geometry::TriangleMesh input = vessel::readMesh(a.in, a.unit);
  vessel::requirePlausibleSize(vessel::checkMesh(input), a.unit, a.in);
  std::string source = a.in;
  for (const std::string& anatomy : a.joins)
  {
    vessel::append(input, vessel::loadAnatomy(anatomy).mesh);
    source += " + " + anatomy;
  }
  const std::filesystem::path out(a.out);
  writeText("", a.out);  // refused now rather than after minutes of work

  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&](const std::string& stage)
  {
    if (!a.quiet)
      std::fprintf(stderr, "%6.1f s  %s\n",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), stage.c_str());
  };
  const vessel::PreparedVessel made = vessel::prepareVessel(input, source, a.options, progress);
  const std::string stem = (out.parent_path() / out.stem()).string();
  vessel::writeObj(made.mesh, a.out);
  vessel::writeCentreline(made.centreline, out.stem().string(), stem + "_centreline.yaml");
  writeText(made.report.json(made.centreline), stem + "_report.json");
  std::cout << made.report.text(made.centreline) << "wrote " << a.out << ", " << stem << "_centreline.yaml, " << stem
            << "_report.json\n"
            << "to use it: simulate config/scenes/mesh.yaml --set vessel.mesh="
            << std::filesystem::absolute(out).string() << " --set vessel.unit=1\n";
  return made.report.withinDistance() ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const Arguments arguments = parse({argv + 1, argv + argc});
    if (arguments.help)
    {
      std::cout << kUsage;
      return 0;
    }
    return prepare(arguments);
  }
  catch (const std::invalid_argument& error)
  {
    return wrongUse(error.what());
  }
  catch (const InputError& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
