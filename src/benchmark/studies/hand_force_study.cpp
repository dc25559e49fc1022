#include "benchmark/studies/hand_force_study.h"
#include "scene/scene_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "benchmark/studies/hand_force_runs.h"
#include "geometry/mesh_distance.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTimeStep = 1e-3;   // s, of all scenes here
constexpr double kPlotted = 0.5e-3;  // m of insertion that a chart's point is the mean of
constexpr double kFrom = 0.02;       // m of insertion from where on means are taken: the wire touches the wall
constexpr double kMostNoise = 0.03;  // asked
constexpr double kTissue = 8e5;      // of an artery's wall per length of wire [N/m²]
constexpr double kAlike = 0.05;      // curves whose means differ by less are alike

/** A curve of a chart. */
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
  Section section{"hand_force_curves", "Force at the hand against insertion",
                  "A 0.014\" wire (EI 50 N·mm², graded to 1.6 N·mm² at the tip) is pushed 80 mm from a catheter in the "
                  "left ostium through the generated anatomy's left coronary artery (smoothed once), μ = 0.1, Δt = 1 "
                  "ms, as in Fig. 10 of Li et al. A: speed. B: bending modulus. C: shear modulus and angle by which "
                  "the hand turns over the whole insertion, angled tip; drawn is the torque at the hand. D: shape of "
                  "the tip; drawn is the normal force on its last 5 mm. Points are means over 0.5 mm.",
                  Table({"panel", "curve", "insertion [mm]", "force [mN]", "torque [µN·m]", "tip [mN]"}),
                  "hand_force.png"};
  section.only_csv = true;
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
  Section section{
      "hand_force_means", "Means of the curves and parts of the force",
      "Over the insertion from 20 mm on. Tip: normal force of the wall on the last 5 mm. Parts: docs/PHYSICS.md.",
      Table({"panel", "curve", "force [mN]", "bending", "friction", "inertia", "largest [mN]", "mean torque [µN·m]",
             "tip [mN]", "largest at the tip [mN]"}),
      ""};
  for (const Curve& curve : curves)
    section.table.add({curve.panel, curve.name, number(1e3 * curve.force()),
                       number(1e3 * curve.part(&rod::HandForceParts::bending)),
                       number(1e3 * curve.part(&rod::HandForceParts::friction)),
                       number(1e3 * curve.part(&rod::HandForceParts::inertia), 2), number(1e3 * curve.largestForce()),
                       number(1e6 * curve.torque()), number(1e3 * curve.tip()), number(1e3 * curve.largestTip())});
  return section;
}

/** Whether values rise from one to the next, or are alike. */
std::string risingWord(const std::vector<double>& values)
{
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*high - *low < kAlike * *high)
    return "alike";
  return std::is_sorted(values.begin(), values.end()) ? "yes" : "no";
}

Section orderings(const std::vector<Curve>& curves)
{
  Section section{"hand_force_orderings", "The paper's orderings", "",
                  Table({"panel", "the paper", "measured, lowest to highest as the paper has it", "holds"}), ""};
  const auto add = [&section](const std::string& panel, const std::string& claim, const std::vector<double>& values,
                              double scale, const std::string& unit)
  {
    std::string list;
    for (const double value : values)
      list += (list.empty() ? "" : ", ") + number(scale * value);
    section.table.add({panel, claim, list + " " + unit, risingWord(values)});
  };
  const auto forces = [&curves](const std::string& panel, const std::vector<std::string>& names)
  {
    std::vector<double> values;
    for (const std::string& name : names)
      values.push_back(curveOf(curves, panel, name).force());
    return values;
  };
  const auto torques = [&curves](const std::vector<std::string>& names)
  {
    std::vector<double> values;
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
  add("C", "the same, axial force, shear modulus", forces("C", shear), 1e3, "mN");
  add("C", "the same, axial force, angle", forces("C", turns), 1e3, "mN");
  for (const std::string tip : {"angled", "semicircle", "J"})
    add("D", tip + " tip: lower than the straight one, largest force at the tip",
        {curveOf(curves, "D", tip).largestTip(), curveOf(curves, "D", "straight").largestTip()}, 1e3, "mN");
  for (const std::string tip : {"angled", "semicircle", "J"})
    add("D", tip + " tip: the same, force at the hand", forces("D", {tip, "straight"}), 1e3, "mN");
  section.text =
      "Alike: means within 5 %. Where the paper's ordering is not there, it is not in these assumptions:\n\n- **A, "
      "speed.** Balance along the wire is T′ = −f·t, f = wall friction + ρ_l a + drag. Neither Coulomb's friction nor "
      "the bending ½EIκ² depends on the speed, and inertia is of the order ρ_l v² (momentum that enters a bend): 8e-4 "
      "kg/m · (0.1 m/s)² = 8 µN, a thousandth of the force. A force that grows with the speed needs viscous terms (a "
      "penalty wall's damping, drag, a lubricated coating), none of which is in the scene.\n- **B, bending modulus.** "
      "Bending and, by the wall forces that bend the wire, friction are both in proportion to EI: the force doubles "
      "with it.\n- **C, shear modulus and angle.** A straight isotropic body whose far end is free carries no torque; "
      "its energy ½EI∫κ² holds no GJ, so neither does the axial force. GJ acts through the curved tip only: bend and "
      "wall hold it by a torque M(φ) that EI and the tip's rest curvature bound, and the hand's angle is Θ = φ + "
      "M∫ds/GJ. Here ∫ds/GJ = 3.1e4 rad/(N·m), so a torque of 1.6 µN·m winds the wire up by 3° of the 180° turned: the "
      "tip follows the hand, GJ changes where it is by degrees, and a larger angle turns it on to where M is smaller. "
      "A torque GJ·Θ/L, in proportion to both, needs a tip that cannot turn.\n- **D, tips.** The shaft makes the force "
      "at the hand, the tip (EI 1.6 of 50 N·mm²) hardly counts. Counted at the tip are normal forces on its last 5 mm: "
      "a curved tip is straightened by the vessel and presses sideways with what its rest curvature takes, on top of "
      "what a straight one does. Pushes head-on into a wall, where curved tips give way, are not measured here.";
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
  Section section{"hand_force_nodes", "Mean force over the number of nodes",
                  "A plain 0.035\" wire (EI 291 N·mm²) of 0.3 m at 35 mm/s, μ = 0.1, 200 mm (quick: 120 mm): a channel "
                  "of 8 mm with two bends in different planes, smoothed twice, and the generated anatomy from the "
                  "femoral artery to below the aortic bifurcation, smoothed once. Asked: within 3 % of 240 nodes.",
                  Table({"vessel", "nodes", "mean force [mN]", "difference from 240 nodes [%]", "holds"}), ""};
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

/** Largest distance of either surface's corners from the other surface [m]. */
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

/** A wall and how it is met. */
struct WallCase
{
  bool anatomy;
  int smoothing;     ///< Loop subdivisions
  double stiffness;  ///< of the contacts with a rigid wall [N/m], or of a wall that gives way [N/m²]
  bool rigid = true;
};

void addNoise(Table& table, const WallCase& wall, double travel)
{
  const std::string scene = shaftScene(wall.anatomy, 480, wall.smoothing, travel);
  const std::string law = wall.rigid ? "solver.contact_stiffness=" : "vessel.stiffness=";
  const std::vector<HandSample> samples = pushThrough(scene, {law + number(wall.stiffness, 6)});
  const geometry::TriangleMesh mesh = meshOf(scene);
  const double off = wall.smoothing > 0 ? departure(meshOf(shaftScene(wall.anatomy, 480, 0, travel)), mesh) : 0.0;
  const double noise = noiseOf(samples, kTimeStep);
  const std::string verdict = noise <= kMostNoise ? "yes" : "no";
  table.add({wall.anatomy ? "anatomy" : "channel", std::to_string(wall.smoothing),
             wall.rigid ? "rigid, " + number(1e-3 * wall.stiffness) + " N/mm"
                        : number(1e-6 * wall.stiffness) + " N/mm per mm",
             std::to_string(mesh.triangles.size()), number(1e3 * off),
             number(1e3 * meanOf(samples, &HandSample::force, kFrom)), number(100.0 * noise, 2),
             wall.smoothing == 0 ? "" : verdict});
}

Section smoothness(bool quick, const Progress& progress)
{
  Section section{
      "hand_force_noise", "Noise of the force",
      "The same wire with 480 nodes, every step of 1 ms. Noise: RMS of what is faster than 5 Hz (7 mm of travel at 35 "
      "mm/s), over the mean; the first and the last half second are left out. It holds whatever is in that band, so "
      "also what tip and wall really do to each other. The rest falls with the facets' size and with the contacts' "
      "stiffness. Departure: largest distance between the smoothed surface and the original one, corners of both. "
      "Wall: rigid, every contact with `solver.contact_stiffness` (by default 100 N/mm; 30 give way by about 2 µm "
      "here), or a tissue's `vessel.stiffness` per length of wire. Asked: 3 % on a smoothed wall.",
      Table({"vessel", "smoothing", "wall", "triangles", "departure [mm]", "mean force [mN]", "noise [%]", "holds"}),
      ""};
  const WallCase walls[] = {{false, 0, 1e5},          {false, 1, 1e5}, {false, 2, 1e5}, {true, 0, 1e5},
                            {true, 1, 1e5},           {true, 2, 1e5},  {true, 2, 3e4},  {false, 1, kTissue, false},
                            {true, 1, kTissue, false}};
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
