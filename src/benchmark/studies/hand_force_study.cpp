#include "benchmark/studies/hand_force_study.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "benchmark/studies/hand_force_charts.h"
#include "benchmark/studies/hand_force_runs.h"
#include "geometry/mesh_distance.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTimeStep = 1e-3;   // time step of all scenes [s]
constexpr double kFrom = 0.02;       // insertion at which means start, after first contact [m]
constexpr double kMostNoise = 0.03;  // largest accepted noise
constexpr double kTissue = 8e5;      // stiffness of an arterial wall per length of wire [N/m²]

void addDeviation(Table& table, const std::string& vessel, const std::vector<HandSample>& samples, int nodes,
                  double reference)
{
  const double mean = meanOf(samples, &HandSample::force, kFrom);
  const double deviation = mean / reference - 1.0;
  table.add({vessel, std::to_string(nodes), number(1e3 * mean, 4), number(100.0 * deviation, 2),
             std::abs(deviation) <= 0.03 ? "yes" : "no"});
}

Section overNodes(bool quick, const Progress& progress)
{
  Section section(handForceTables(), "hand_force_nodes");
  section.text =
      "A plain 0.035\" wire (EI 291 N·mm²) of 0.3 m, pushed 200 mm (quick: 120 mm) at 35 mm/s, μ = 0.1. Channel: 8 mm "
      "diameter, two bends in different planes, smoothed twice. Anatomy: the generated anatomy from the femoral "
      "artery to below the aortic bifurcation, smoothed once. Criterion: within 3 % of 240 nodes.";
  double done = 0.0;
  for (const bool anatomy : {false, true})
  {
    double reference = NAN;
    for (const int nodes : {240, 480, 960})
    {
      const std::string vessel = anatomy ? "anatomy" : "channel";
      progress(0.5 + 0.3 * done++ / 6.0, "nodes, " + vessel + ", " + std::to_string(nodes));
      const std::vector<HandSample> samples =
          pushThrough(shaftScene(anatomy, nodes, anatomy ? 1 : 2, quick ? 0.12 : 0.2));
      if (nodes == 240)
        reference = meanOf(samples, &HandSample::force, kFrom);
      addDeviation(section.table, vessel, samples, nodes, reference);
    }
  }
  return section;
}

/** Largest distance between the vertices of either surface and the other surface [m]. */
double departure(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b)
{
  double largest = 0.0;
  const geometry::MeshDistance to_a(a);
  const geometry::MeshDistance to_b(b);
  for (const Eigen::Vector3d& corner : a.vertices)
    largest = std::max(largest, to_b.closest(corner).distance);
  for (const Eigen::Vector3d& corner : b.vertices)
    largest = std::max(largest, to_a.closest(corner).distance);
  return largest;
}

geometry::TriangleMesh meshOf(const std::string& scene_text)
{
  const scene::Scene scene = scene::parseScene(scene_text, "benchmark");
  return scene::buildVessel(*scene.vessel, scene.entry, scene.file).mesh;
}

/** Wall of a noise measurement. */
struct WallCase
{
  bool anatomy;
  int smoothing;     ///< number of Loop subdivisions
  double stiffness;  ///< contact stiffness of a rigid wall [N/m], or stiffness of a compliant wall [N/m²]
  bool rigid = true;
  bool smooth = false;  ///< vessel.wall: smooth
};

void addNoise(Table& table, const WallCase& wall, double travel)
{
  const std::string scene = shaftScene(wall.anatomy, 480, wall.smoothing, travel);
  const std::string law = wall.rigid ? "solver.contact_stiffness=" : "vessel.stiffness=";
  const std::vector<HandSample> samples = pushThrough(
      scene, {law + number(wall.stiffness, 6), std::string("vessel.wall=") + (wall.smooth ? "smooth" : "facets")});
  const geometry::TriangleMesh mesh = meshOf(scene);
  const double off = wall.smoothing > 0 ? departure(meshOf(shaftScene(wall.anatomy, 480, 0, travel)), mesh) : 0.0;
  const double noise = noiseOf(samples, kTimeStep);
  const std::string verdict = noise <= kMostNoise ? "yes" : "no";
  table.add({wall.anatomy ? "anatomy" : "channel", std::to_string(wall.smoothing),
             (wall.smooth ? "smooth wall, " : "") + (wall.rigid ? "rigid, " + number(1e-3 * wall.stiffness) + " N/mm"
                                                                : number(1e-6 * wall.stiffness) + " N/mm per mm"),
             std::to_string(mesh.triangles.size()), number(1e3 * off),
             number(1e3 * meanOf(samples, &HandSample::force, kFrom)), number(100.0 * noise, 2),
             wall.smoothing == 0 && !wall.smooth ? "" : verdict});
}

Section smoothness(bool quick, const Progress& progress)
{
  Section section(handForceTables(), "hand_force_noise");
  section.text =
      "The wire of the table above with 480 nodes, sampled at every step of 1 ms. Noise: RMS of the force above 5 Hz "
      "(7 mm of travel at 35 mm/s) over its mean; the first and last half second are omitted. The band includes the "
      "physical interaction of tip and wall; the remainder decreases with the size of the facets and with the contact "
      "stiffness. Departure: largest distance between the vertices of the smoothed and the original surface and the "
      "other surface. Wall: rigid with `solver.contact_stiffness` (default 100 N/mm; 30 N/mm yield by about 2 µm "
      "here), or compliant with `vessel.stiffness` per length of wire. Smooth wall: `vessel.wall: smooth`. Criterion: "
      "3 % "
      "on a smoothed or smooth wall.";
  const WallCase walls[] = {{false, 0, 1e5},
                            {false, 1, 1e5},
                            {false, 2, 1e5},
                            {true, 0, 1e5},
                            {true, 1, 1e5},
                            {true, 2, 1e5},
                            {true, 2, 3e4},
                            {false, 1, kTissue, false},
                            {true, 1, kTissue, false},
                            {false, 0, 1e5, true, true},
                            {true, 0, 1e5, true, true}};
  double done = 0.0;
  for (const WallCase& wall : walls)
  {
    progress(0.8 + 0.2 * done++ / static_cast<double>(std::size(walls)),
             std::string("noise, ") + (wall.anatomy ? "anatomy" : "channel") + ", smoothed " +
                 std::to_string(wall.smoothing) + " times");
    addNoise(section.table, wall, quick ? 0.12 : 0.2);
  }
  return section;
}

}  // namespace

std::vector<TableSpec> handForceTables()
{
  return {{"hand_force_curves",
           "Force at the hand over insertion",
           {"panel", "curve", "insertion [mm]", "force [mN]", "torque [µN·m]", "tip [mN]"},
           "hand_force.png"},
          {"hand_force_means",
           "Means of the curves and parts of the force",
           {"panel", "curve", "force [mN]", "bending", "friction", "inertia", "largest [mN]", "mean torque [µN·m]",
            "tip [mN]", "largest at the tip [mN]"},
           ""},
          {"hand_force_orderings",
           "Orderings of the paper",
           {"panel", "the paper", "measured, lowest to highest as the paper has it", "holds"},
           ""},
          {"hand_force_impulse",
           "Impulse force of the scheme of the paper",
           {"time step [ms]", "panel", "curve", "impulse force [mN]", "largest [mN]", "force at the hand [mN]",
            "mean torque [µN·m]", "tip [mN]", "largest at the tip [mN]", "largest penetration [mm]", "end"},
           ""},
          {"hand_force_impulse_orderings",
           "Orderings of the paper by its impulse force",
           {"time step [ms]", "panel", "the paper", "measured, lowest to highest as the paper has it", "holds"},
           ""},
          {"hand_force_nodes",
           "Mean force over the number of nodes",
           {"vessel", "nodes", "mean force [mN]", "difference from 240 nodes [%]", "holds"},
           ""},
          {"hand_force_noise",
           "Noise of the force",
           {"vessel", "smoothing", "wall", "triangles", "departure [mm]", "mean force [mN]", "noise [%]", "holds"},
           ""}};
}

std::vector<Section> handForceStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = chartSections(handForceTables(), progress);
  sections.push_back(overNodes(options.quick, progress));
  sections.push_back(smoothness(options.quick, progress));
  return sections;
}

}  // namespace endovascular_sim::benchmark
