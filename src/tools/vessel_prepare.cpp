#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "scene/file_search.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/centreline/centreline_file.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/prepare/prepare.h"
#include "vessel/repair/lumen_check.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_size.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

struct Options
{
  std::string in;
  std::string out;
  std::vector<std::string> joins;  ///< anatomy files
  std::vector<std::string> plugs;  ///< x,y,z,radius of each [m]
  double unit = 0.0;               ///< length of a unit of the input [m]
  bool quiet = false;
  vessel::PrepareOptions prepare;
};

/** @throws InputError for a text that is no plug */
vessel::Plug plugOf(const std::string& text)
{
  vessel::Plug plug;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf%c", &plug.centre.x(), &plug.centre.y(), &plug.centre.z(), &plug.radius,
                  &rest) != 4)
    throw InputError("command line", "--plug", "requires x,y,z,radius in metres, not '" + text + "'");
  const std::pair<Quantity, double> checks[] = {{quantities::kPosition, plug.centre.cwiseAbs().maxCoeff()},
                                                {quantities::kVesselRadius, plug.radius}};
  for (const auto& [quantity, value] : checks)
    if (plausibility(quantity, value) != Plausibility::kUsual)
      throw InputError("command line", "--plug",
                       "requires x,y,z,radius in metres, not '" + text + "'; " + plausibilityMessage(quantity, value));
  return plug;
}

std::string plugError(const std::string& text)
{
  try
  {
    plugOf(text);
    return "";
  }
  catch (const InputError& error)
  {
    return error.what();
  }
}

void addOptions(tools::CommandLine& line, Options& options)
{
  const CLI::Range count(0, 1000000);
  vessel::PrepareOptions& prepare = options.prepare;
  line.argument("IN", options.in, "mesh to prepare: OBJ, STL, PLY, VTP or VTK");
  line.quantity("--unit", options.unit, "METRES", quantities::kMeshUnit,
                "length of a unit of IN [m]: 0.001 for millimetres, 1 for metres")
      ->required()
      ->check(tools::positiveNumber());
  line.option("--out", options.out, "OUT.obj",
              "the vessel in metres (vessel.unit: 1 in a scene); beside it OUT_report.json and, as an anatomy file, "
              "OUT_centreline.yaml: the centreline with diameters")
      ->required()
      ->check([](const std::string& name)
              { return std::filesystem::path(name).extension() == ".obj" ? "" : "requires a name that ends in .obj"; });
  line.quantity("--max-distance", prepare.max_distance, "M", quantities::kSurfaceDistance,
                "largest distance between the walls of input and result, in both directions [0.0002]");
  line.quantity(
      "--voxel", prepare.voxel, "M", quantities::kSurfaceDistance,
      "edge of the grid's cells [2/3 of max-distance]; walls between lumens thinner than two cells may be lost");
  line.quantity("--bridge", prepare.bridge, "M", quantities::kGap,
                "joins loose pieces within this distance of the vessel by a tube of their own width [0]");
  line.repeated(
      "--join", options.joins, "ANATOMY.yaml",
      "unites the vessel with an overlapping generated one (an anatomy file in the axes of IN), e.g. the vessels "
      "beyond a cut end");
  line.repeated(
          "--plug", options.plugs, "X,Y,Z,R",
          "for walls with a thickness: closes the lumen by a lid through this point [m], before an opening; R exceeds "
          "the distance to the wall all around. A lumen with all openings closed counts as inside, and the inner "
          "wall is removed")
      ->check(plugError);
  line.flag("--hollow", prepare.hollow,
            "keeps the inner wall and removes the outer one: the lumen is the largest hollow");
  line.flag("--smooth", prepare.smooth, "smooths the edges of coarse facets, within max-distance");
  line.option("--smoothing-rounds", prepare.smoothing_rounds, "N", "number of smoothing passes [30]")->check(count);
  line.option("--facets-around", prepare.facets_around, "N", "facets around every lumen of the result [24]")
      ->check(count);
  line.quantity("--longest-facet", prepare.longest_facet, "M", quantities::kFacetLength,
                "longest facet edge of the result [0.0025]");
  line.repeated(
      "--open", prepare.open, "WHICH",
      "leaves an end open: all, largest, a count (the widest ends), x,y,z in metres (the nearest end), or a branch's "
      "name from the report. Default: all ends are closed. A scene closes flat open ends itself when it "
      "reads the mesh");
  line.quantity("--cut-back", prepare.cut_back, "R", quantities::kScale,
                "distance of the cut from the tip of an open end, in radii of the lumen [1]");
  line.flag("--quiet", options.quiet, "prints the report only");
}

int prepare(Options a)
{
  for (const std::string& plug : a.plugs)
    a.prepare.plugs.push_back(plugOf(plug));
  vessel::MeshRemarks remarks;
  geometry::TriangleMesh input =
      vessel::readMesh(a.in, a.unit, a.quiet ? ProgressReport() : progressOnErrorStream(), &remarks);
  tools::printWarnings("vessel_prepare", remarks.warnings);
  tools::printNotes(a.in, remarks.notes);
  vessel::requirePlausibleSize(input, vessel::checkMesh(input), a.unit, a.in);
  std::string source = a.in;
  for (const std::string& anatomy : a.joins)
  {
    vessel::append(input, vessel::loadAnatomy(anatomy).mesh);
    source += " + " + anatomy;
  }
  const std::filesystem::path out(a.out);
  tools::requireWritable(a.out);

  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&](const std::string& stage)
  {
    if (!a.quiet)
      std::fprintf(stderr, "%6.1f s  %s\n",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), stage.c_str());
  };
  const vessel::PreparedVessel made = vessel::prepareVessel(input, source, a.prepare, progress);
  const std::string stem = (out.parent_path() / out.stem()).string();
  vessel::writeObj(made.mesh, a.out);
  vessel::writeCentreline(made.centreline, out.stem().string(), stem + "_centreline.yaml");
  tools::writeFile(stem + "_report.json", made.report.json(made.centreline));
  if (const vessel::ThickWall wall = vessel::findThickWall(made.mesh, vessel::checkMesh(made.mesh)); wall.found())
    tools::printWarnings("vessel_prepare", {a.out + ": " + wall.text()});
  std::cout << made.report.text(made.centreline) << "wrote " << a.out << ", " << stem << "_centreline.yaml, " << stem
            << "_report.json\n"
            << "to use the vessel: rosrun endovascular_sim simulate "
            << std::filesystem::absolute(scene::configFolder() + "/scenes/mesh.yaml").string()
            << " --set vessel.mesh=" << std::filesystem::absolute(out).string() << " --set vessel.unit=1\n";
  return made.report.withinDistance() ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "vessel_prepare",
      "Makes a vessel for scenes out of a mesh that they reject: overlapping pieces, holes, non-manifold "
      "edges, inconsistent orientation, coarse facets.",
      "Exit code: 0 success, within max-distance; 1 rejected (the reason is on the error stream); 2 "
      "wrong arguments; 3 success, but beyond max-distance at places that the report names.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return prepare(options); });
}
