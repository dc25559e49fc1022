#include "benchmark/studies/hand_force_charts.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "benchmark/studies/hand_force_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kTimeStep = 1e-3;                    // time step of the default scheme [s]
constexpr double kImpulseTimeSteps[] = {1e-3, 1e-4};  // time steps of the scheme `paper` [s]
constexpr double kPlotted = 0.5e-3;                   // insertion averaged per point of a chart [m]
constexpr double kFrom = 0.02;                        // insertion at which means start, after first contact [m]
constexpr double kAlike = 0.05;                       // largest difference of equal means

/** Curve of a chart. */
struct Curve
{
  std::string panel;
  std::string name;
  CoronaryPush push;
  std::vector<HandSample> samples;

  double mean(double HandSample::*value) const { return meanOf(samples, value, kFrom); }
  double largest(double HandSample::*value) const
  {
    double result = 0.0;
    for (const HandSample& sample : samples)
      result = std::max(result, std::abs(sample.*value));
    return result;
  }
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
};

const std::string kAngledTip = "{shape: angled, radius: 1.5e-3, angle: 0.785398, straight: 1.0e-3}";

/** @param scheme "kkt" or "paper"
 *  @param time_step [s] */
std::vector<Curve> listCurves(const std::string& scheme, double time_step)
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
  for (Curve& curve : curves)
  {
    curve.push.scheme = scheme;
    curve.push.time_step = time_step;
  }
  return curves;
}

const Curve& curveOf(const std::vector<Curve>& curves, const std::string& panel, const std::string& name)
{
  return *std::find_if(curves.begin(), curves.end(),
                       [&](const Curve& curve) { return curve.panel == panel && curve.name == name; });
}

Section chartPoints(const std::vector<TableSpec>& specs, const std::vector<Curve>& curves)
{
  Section section(specs, "hand_force_curves");
  section.text =
      "A 0.014\" wire (EI 50 N·mm², graded to 1.6 N·mm² at the tip) is pushed 80 mm from a catheter in the left "
      "ostium into the left coronary artery of the generated anatomy (smoothed once); μ = 0.1, Δt = 1 ms, as in Fig. "
      "10 of the paper. A: speed. B: bending modulus. C: shear modulus and final rotation of the hand, with an angled "
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

Section chartMeans(const std::vector<TableSpec>& specs, const std::vector<Curve>& curves)
{
  Section section(specs, "hand_force_means");
  section.text =
      "Means over insertions from 20 mm. Tip: normal force of the wall on the last 5 mm. Parts of the force: "
      "docs/PHYSICS.md.";
  for (const Curve& curve : curves)
    section.table.add({curve.panel, curve.name, number(1e3 * curve.mean(&HandSample::force)),
                       number(1e3 * curve.part(&rod::HandForceParts::bending)),
                       number(1e3 * curve.part(&rod::HandForceParts::friction)),
                       number(1e3 * curve.part(&rod::HandForceParts::inertia), 2),
                       number(1e3 * curve.largest(&HandSample::force)), number(1e6 * curve.torque()),
                       number(1e3 * curve.mean(&HandSample::tip_force)),
                       number(1e3 * curve.largest(&HandSample::tip_force))});
  return section;
}

/** Verdict on a sequence: "yes" if it increases, "alike" if the values are equal within kAlike, else "no"; "–" if a run
 * has ended before kFrom. */
std::string verdictOf(const std::vector<double>& values)
{
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    return "–";
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*high - *low < kAlike * *high)
    return "alike";
  return std::is_sorted(values.begin(), values.end()) ? "yes" : "no";
}

/** An ordering that the paper states, with its verdict. */
struct Ordering
{
  std::string panel;
  std::string claim;
  std::string values;  ///< lowest to highest as the paper has it
  std::string verdict;
};

/** Orderings of the paper's charts.
 *  @param force quantity that stands for the force at the hand [N] */
std::vector<Ordering> orderingsOf(const std::vector<Curve>& curves, double HandSample::*force)
{
  std::vector<Ordering> result;
  const auto add = [&result](const std::string& panel, const std::string& claim, const std::vector<double>& values,
                             double scale, const std::string& unit)
  {
    std::string list;
    for (const double value : values)
      list += (list.empty() ? "" : ", ") + number(scale * value);
    result.push_back({panel, claim, list + " " + unit, verdictOf(values)});
  };
  const auto values = [&curves](const std::string& panel, const std::vector<std::string>& names,
                                const std::function<double(const Curve&)>& value)
  {
    std::vector<double> list;
    list.reserve(names.size());
    for (const std::string& name : names)
      list.push_back(value(curveOf(curves, panel, name)));
    return list;
  };
  const auto mean = [force](const Curve& curve) { return curve.mean(force); };
  const auto torque = [](const Curve& curve) { return curve.torque(); };
  const auto tip = [](const Curve& curve) { return curve.largest(&HandSample::tip_force); };
  const std::vector<std::string> shear = {"0.5 G, 180°", "1 G, 180°", "2 G, 180°"};
  const std::vector<std::string> turns = {"1 G, 90°", "1 G, 180°", "1 G, 360°"};
  add("A", "the slowest push has the smallest force", values("A", {"10 mm/s", "35 mm/s", "100 mm/s"}, mean), 1e3, "mN");
  add("B", "the largest bending modulus has the largest force", values("B", {"0.5 E", "1 E", "2 E"}, mean), 1e3, "mN");
  add("C", "a larger shear modulus has a larger feedback: torque", values("C", shear, torque), 1e6, "µN·m");
  add("C", "a larger angle of twist has a larger feedback: torque", values("C", turns, torque), 1e6, "µN·m");
  add("C", "a larger shear modulus has a larger feedback: axial force", values("C", shear, mean), 1e3, "mN");
  add("C", "a larger angle of twist has a larger feedback: axial force", values("C", turns, mean), 1e3, "mN");
  for (const std::string name : {"angled", "semicircle", "J"})
    add("D", name + " tip: lower than the straight one, largest force at the tip", values("D", {name, "straight"}, tip),
        1e3, "mN");
  for (const std::string name : {"angled", "semicircle", "J"})
    add("D", name + " tip: lower than the straight one, force at the hand", values("D", {name, "straight"}, mean), 1e3,
        "mN");
  return result;
}

Section orderings(const std::vector<TableSpec>& specs, const std::vector<Curve>& curves)
{
  Section section(specs, "hand_force_orderings");
  for (const Ordering& one : orderingsOf(curves, &HandSample::force))
    section.table.add({one.panel, one.claim, one.values, one.verdict});
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

/** Runs the curves of the scheme `paper` with one time step.
 *  @param means table of the means
 *  @param verdicts table of the orderings */
void addImpulses(Table& means, Table& verdicts, double time_step, const std::function<void(const Curve&)>& progress)
{
  std::vector<Curve> curves = listCurves("paper", time_step);
  const std::string step = number(1e3 * time_step);
  for (Curve& curve : curves)
  {
    progress(curve);
    const auto wanted = static_cast<std::size_t>(std::lround(curve.push.travel / curve.push.speed / time_step));
    curve.samples = pushThrough(sceneText(curve.push), {}, Rejection::kEnds);
    const bool whole = curve.samples.size() == wanted;
    means.add({step, curve.panel, curve.name, number(1e3 * curve.mean(&HandSample::wall_force)),
               number(1e3 * curve.largest(&HandSample::wall_force)), number(1e3 * curve.mean(&HandSample::force)),
               number(1e6 * curve.torque()), number(1e3 * curve.mean(&HandSample::tip_force)),
               number(1e3 * curve.largest(&HandSample::tip_force)),
               number(1e3 * curve.largest(&HandSample::penetration)),
               whole ? "pushed" : "rejected after " + std::to_string(curve.samples.size()) + " steps"});
  }
  for (const Ordering& one : orderingsOf(curves, &HandSample::wall_force))
    verdicts.add({step, one.panel, one.claim, one.values, one.verdict});
}

}  // namespace

std::vector<Section> chartSections(const std::vector<TableSpec>& specs, const Progress& progress)
{
  std::vector<Curve> curves = listCurves("kkt", kTimeStep);
  double done = 0.0;
  const auto show = [&progress, &done](const Curve& curve)
  {
    progress(0.5 * std::min(1.0, done++ / 39.0), "chart " + curve.panel + ", " + curve.name + ", " + curve.push.scheme);
  };
  for (Curve& curve : curves)
  {
    show(curve);
    curve.samples = pushThrough(sceneText(curve.push));
  }
  std::vector<Section> sections = {chartPoints(specs, curves), chartMeans(specs, curves), orderings(specs, curves)};
  Section means(specs, "hand_force_impulse");
  Section verdicts(specs, "hand_force_impulse_orderings");
  for (const double time_step : kImpulseTimeSteps)
    addImpulses(means.table, verdicts.table, time_step, show);
  means.text =
      "The same pushes with the scheme `paper` and its equation (6), F = Σ m d/Δt² over the penetration depths d: the "
      "magnitudes of "
      "the wall forces of all nodes, summed (mean from 20 mm, and largest). A static force F penetrates by F Δt²/m. A "
      "run ends at a "
      "rejected step.";
  verdicts.text = "As above, with the impulse force in place of the force at the hand. The torque is that at the hand.";
  sections.push_back(means);
  sections.push_back(verdicts);
  return sections;
}

}  // namespace endovascular_sim::benchmark
