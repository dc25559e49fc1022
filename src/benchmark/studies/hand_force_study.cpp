#include "benchmark/studies/hand_force_study.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "benchmark/studies/hand_force_runs.h"
#include "geometry/mesh_distance.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTimeStep = 1e-3;   // time step of all scenes [s]
constexpr double kPlotted = 0.5e-3;  // insertion averaged per point of a chart [m]
constexpr double kFrom = 0.02;       // insertion at which means start, after first contact [m]
constexpr double kMostNoise = 0.03;  // largest accepted noise
constexpr double kTissue = 8e5;      // stiffness of an arterial wall per length of wire [N/m²]
constexpr double kAlike = 0.05;      // largest difference of equal means

/** Curve of a chart. */
struct Curve
{
  std::string panel;
  std::string name;
  CoronaryPush push;
  std::vector<HandSample> samples;

  double force() const { return meanOf(samples, &HandSample::force, kFrom); }
  double tip() const { return meanOf(samples, &HandSample::tip_force, kFrom); }
  double largestTip() const { return largest(&HandSample::tip_force); }
  double largestForce() const { return largest(&HandSample::force); }
  double torque() const
  {
    double sum = 0.0;
    for (const HandSample& sample : samples)
      sum += std::abs(sample.torque);
    return sum / static_cast<double>(samples.size());
  }
  double part(double rod::HandForceParts::*value) const
  {
    double sum = 0.0;
    int count = 0;
    for (const HandSample& sample : samples)
      if (sample.insertion >= kFrom)
      {
        sum += sample.parts.*value;
        ++count;
      }
    return sum / count;
  }

private:
  double largest(double HandSample::*value) const
  {
    double result = 0.0;
    for (const HandSample& sample : samples)
      result = std::max(result, std::abs(sample.*value));
    return result;
  }
};

const std::string kAngledTip = "{shape: angled, radius: 1.5e-3, angle: 0.785398, straight: 1.0e-3}";

std::vector<Curve> listCurves()
{
  std::vector<Curve> curves;
  for (const double speed : {0.01, 0.035, 0.1})
  {
    CoronaryPush push;
    push.speed = speed;
    curves.push_back({"A", number(1e3 * speed) + " mm/s", push, {}});
  }
  for (const double factor : {0.5, 1.0, 2.0})
  {
    CoronaryPush push;
    push.stiffness = factor;
    curves.push_back({"B", number(factor) + " E", push, {}});
  }
  for (const auto& [shear, turn] : {std::pair(0.5, 180.0), {1.0, 180.0}, {2.0, 180.0}, {1.0, 90.0}, {1.0, 360.0}})
  {
    CoronaryPush push;
    push.shear = shear;
    push.turn = turn * M_PI / 180.0;
    push.tip = kAngledTip;
    curves.push_back({"C", number(shear) + " G, " + number(turn) + "°", push, {}});
  }
  const std::pair<const char*, std::string> tips[] = {
      {"straight", ""},
      {"angled", kAngledTip},
      {"semicircle", "{shape: semicircle, radius: 1.0e-3}"},
      {"J", "{shape: j, radius: 1.0e-3, angle: 3.141592, straight: 1.5e-3}"}};
  for (const auto& [name, tip] : tips)
  {
    CoronaryPush push;
    push.tip = tip;
    curves.push_back({"D", name, push, {}});
  }
  return curves;
}

const Curve& curveOf(const std::vector<Curve>& curves, const std::string& panel, const std::string& name)
{
  return *std::find_if(curves.begin(), curves.end(),
                       [&](const Curve& curve) { return curve.panel == panel && curve.name == name; });
}

Section chartPoints(const std::vector<Curve>& curves)
{
  Section section(handForceTables(), "hand_force_curves");
  section.text =
      "A 0.014\" wire (EI 50 N·mm², graded to 1.6 N·mm² at the tip) is pushed 80 mm from a catheter in the left "
      "ostium into the left coronary artery of the generated anatomy (smoothed once); μ = 0.1, Δt = 1 ms, as in Fig. "
      "10 of Li et al. A: speed. B: bending modulus. C: shear modulus and final rotation of the hand, with an angled "
      "tip; the plot shows the torque at the hand. D: shape of the tip; the plot shows the normal force on the last 5 "
      "mm. Points are means over 0.5 mm.";
  for (const Curve& curve : curves)
  {
    const double end = curve.samples.back().insertion;
    for (double from = curve.samples.front().insertion; from < end; from += kPlotted)
    {
      const auto mean = [&curve, from](double HandSample::*value)
      { return meanOf(curve.samples, value, from, from + kPlotted); };
      section.table.add({curve.panel, curve.name, number(1e3 * mean(&HandSample::insertion), 5),
                         number(1e3 * mean(&HandSample::force), 4), number(1e6 * mean(&HandSample::torque), 4),
                         number(1e3 * mean(&HandSample::tip_force), 4)});
    }
  }
  return section;
}

Section chartMeans(const std::vector<Curve>& curves)
{
  Section section(handForceTables(), "hand_force_means");
  section.text =
      "Means over insertions from 20 mm. Tip: normal force of the wall on the last 5 mm. Parts of the force: "
      "docs/PHYSICS.md.";
  for (const Curve& curve : curves)
    section.table.add({curve.panel, curve.name, number(1e3 * curve.force()),
                       number(1e3 * curve.part(&rod::HandForceParts::bending)),
                       number(1e3 * curve.part(&rod::HandForceParts::friction)),
                       number(1e3 * curve.part(&rod::HandForceParts::inertia), 2), number(1e3 * curve.largestForce()),
                       number(1e6 * curve.torque()), number(1e3 * curve.tip()), number(1e3 * curve.largestTip())});
  return section;
}

/** Verdict on a sequence: "yes" if it increases, "alike" if the values are equal within kAlike, else "no". */
std::string verdictOf(const std::vector<double>& values)
{
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*high - *low < kAlike * *high)
    return "alike";
  return std::is_sorted(values.begin(), values.end()) ? "yes" : "no";
}

Section orderings(const std::vector<Curve>& curves)
{
  Section section(handForceTables(), "hand_force_orderings");
  const auto add = [&section](const std::string& panel, const std::string& claim, const std::vector<double>& values,
                              double scale, const std::string& unit)
  {
    std::string list;
    for (const double value : values)
      list += (list.empty() ? "" : ", ") + number(scale * value);
    section.table.add({panel, claim, list + " " + unit, verdictOf(values)});
  };
  const auto forces = [&curves](const std::string& panel, const std::vector<std::string>& names)
  {
    std::vector<double> values;
    values.reserve(names.size());
    for (const std::string& name : names)
      values.push_back(curveOf(curves, panel, name).force());
    return values;
  };
  const auto torques = [&curves](const std::vector<std::string>& names)
  {
    std::vector<double> values;
    values.reserve(names.size());
    for (const std::string& name : names)
      values.push_back(curveOf(curves, "C", name).torque());
    return values;
  };
  const std::vector<std::string> shear = {"0.5 G, 180°", "1 G, 180°", "2 G, 180°"};
  const std::vector<std::string> turns = {"1 G, 90°", "1 G, 180°", "1 G, 360°"};
  add("A", "the slowest push has the smallest force", forces("A", {"10 mm/s", "35 mm/s", "100 mm/s"}), 1e3, "mN");
  add("B", "the largest bending modulus has the largest force", forces("B", {"0.5 E", "1 E", "2 E"}), 1e3, "mN");
  add("C", "a larger shear modulus has a larger feedback: torque", torques(shear), 1e6, "µN·m");
  add("C", "a larger angle of twist has a larger feedback: torque", torques(turns), 1e6, "µN·m");
  add("C", "a larger shear modulus has a larger feedback: axial force", forces("C", shear), 1e3, "mN");
  add("C", "a larger angle of twist has a larger feedback: axial force", forces("C", turns), 1e3, "mN");
  for (const std::string tip : {"angled", "semicircle", "J"})
    add("D", tip + " tip: lower than the straight one, largest force at the tip",
        {curveOf(curves, "D", tip).largestTip(), curveOf(curves, "D", "straight").largestTip()}, 1e3, "mN");
  for (const std::string tip : {"angled", "semicircle", "J"})
    add("D", tip + " tip: lower than the straight one, force at the hand", forces("D", {tip, "straight"}), 1e3, "mN");
  section.text =
      "Alike: means within 5 %. Orderings of the paper that do not appear do not follow from the present "
      "assumptions.\n\n"
      "- **A, speed.** The balance along the wire is T′ = −f·t with f = wall friction + ρ_l a + drag. Neither Coulomb "
      "friction nor the bending term ½EIκ² depends on the speed. Inertia is of order ρ_l v² (momentum flux into a "
      "bend): 8e-4 kg/m · (0.1 m/s)² = 8 µN, a thousandth of the force. A force that increases with the speed "
      "requires viscous terms (a damped penalty wall, drag, a lubricated coating), which the scene does not have.\n"
      "- **B, bending modulus.** Bending forces are proportional to EI, and so is friction, through the wall forces "
      "that bend the wire. The force doubles with EI.\n"
      "- **C, shear modulus and angle.** A straight isotropic shaft with a free distal end carries no torque. Its "
      "energy ½EI∫κ² is independent of GJ, and so is the axial force. GJ acts through the curved tip only: bend and "
      "wall hold the tip by a torque M(φ), bounded by EI and its rest curvature, and the proximal angle is Θ = φ + "
      "M∫ds/GJ. Here ∫ds/GJ = 3.1e4 rad/(N·m), so 1.6 µN·m twist the wire by 3° of 180°: the tip follows the hand. A "
      "larger angle rotates the tip to positions of smaller M. A torque GJ·Θ/L requires a tip that cannot rotate.\n"
      "- **D, tips.** The shaft determines the force at the hand; the tip (EI 1.6 of 50 N·mm²) contributes little. "
      "The tip force is the normal force on the last 5 mm: the vessel straightens a curved tip, whose rest curvature "
      "adds lateral forces to those of a straight one. Frontal pushes into a wall, where curved tips yield, are not "
      "measured.";
  return section;
}

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
  std::vector<Curve> curves = listCurves();
  for (std::size_t k = 0; k < curves.size(); ++k)
  {
    progress(0.5 * static_cast<double>(k) / static_cast<double>(curves.size()),
             "chart " + curves[k].panel + ", " + curves[k].name);
    curves[k].samples = pushThrough(sceneText(curves[k].push));
  }
  std::vector<Section> sections = {chartPoints(curves), chartMeans(curves), orderings(curves)};
  sections.push_back(overNodes(options.quick, progress));
  sections.push_back(smoothness(options.quick, progress));
  return sections;
}

}  // namespace endovascular_sim::benchmark
