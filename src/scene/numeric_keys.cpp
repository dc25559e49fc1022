#include "scene/numeric_keys.h"

#include <algorithm>

#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kWire =
    "{name: w, sections: [{length: 0.5, radius: 4e-4, material: steel, density: 7900, bending_stiffness: 1e-4,"
    " poisson_ratio: 0.3, rest_curvature: {radius: 0.02}}, {length: 0.1, radius: 4e-4, material: steel, density: 7900,"
    " bending_stiffness: 1e-4, poisson_ratio: 0.3, rest_curvature: [0, 0]}]}";

const std::string kBentWire =
    "{name: w, sections: [{length: 0.5, radius: 4e-4, material: steel, density: 7900, bending_stiffness: 1e-4,"
    " poisson_ratio: 0.3}], tip: {shape: angled, radius: 0.01, angle: 1}}";

const std::string kStentSystem =
    "{name: b, kind: balloon_catheter, inner_radius: 5e-4,"
    " sections: [{length: 0.5, radius: 7e-4, material: polymer, density: 1200, young_modulus: 1e9, poisson_ratio: "
    "0.3}],"
    " markers: [{from_tip: 0.01, length: 1e-3}], pressure_line: {}, side_holes: {count: 2, spacing: 5e-3},"
    " balloon: {from_tip: 0.005, length: 0.02, folded_diameter: 1e-3, compliance: [[6e5, 2.8e-3], [1.6e6, 3.2e-3]],"
    " nominal_pressure: 1e6, rated_burst_pressure: 1.6e6, burst_pressure: 2e6, inflation_time: 1, deflation_time: 1},"
    " stent: {crimped_diameter: 1e-3, nominal_diameter: 3e-3, strut_thickness: 8e-5, recoil: 0.05,"
    " expansion: [[1e-3, 0.018], [3e-3, 0.017]]}}";

const std::string kTube = "tube: {radius: 0.005, pieces: [{length: 0.3}]}";

/** Scenes that together visit each branch of the schema. */
const std::vector<std::string> kScenes = {
    // a tube with regions and lesions, a wire of several sections
    "vessel: {friction: 0.1, " + kTube +
        ", friction_regions: [{centre: [0, 0, 0], radius: 0.01, friction: 0.1}],"
        " lesions: [{branch: tube, length: 0.01, grade: 0.5}, {branch: tube, from_start: 0.1, length: 0.01, grade: "
        "0.5},"
        " {at: [0, 0, 0.1], length: 0.01, grade: 0.5}]}\ninstrument: " +
        kWire +
        "\ndrive: {source: script, speed: 0.01, travel: 0.1, limits: {insertion: [0, 0.5]}}\nfluoroscopy: {isocentre: "
        "[0, 0, 0], energy: 60, field: [0.1, 0.1], gantry: {}}\nerrors: {}\n"
        "flow: {circulation: {outlets: {territories: [{branch: tube, share: 0.5}]}}}\n"
        "motion: {patient: {region: {fixed: [{branch: tube}], base: [0, 0, 0], apex: [0, 0, 0.1], centre: [0, 0, 0],"
        " core: 0.1}}}\n",
    // a mesh, adaptive sampling, profiles, a robot
    "vessel: {friction: 0.1, mesh: m.stl, unit: 0.001, rotation: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}\n"
    "entry: {nearest_centreline_end: true, position: [0, 0, 0]}\ninstrument: " +
        kBentWire +
        "\ndrive: {source: topic}\nsampling: {kind: adaptive}\n"
        "robot: {urdf: r.urdf, joints: [{joint: j, instrument: w, motion: insertion}]}\n"
        "fluoroscopy: {isocentre: [0, 0, 0]}\n"
        "sensors: [{name: a, kind: em_tracker}, {name: b, kind: encoder}, {name: c, kind: force_sensor},"
        " {name: d, kind: detector}]\n"
        "faults: [{axis: insertion, kind: slipping, share: 0.5}, {axis: insertion, kind: delayed, delay: 0.1},"
        " {axis: rotation, kind: backlash, play: 0.1}]\n",
    "vessel: {friction: 0.1, mesh: m.stl, unit: 0.001, head: [0, 0, 1], left: [1, 0, 0]}\n"
    "entry: {centreline_end: a}\ninstrument: " +
        kWire +
        "\ndrive: {source: topic}\nfluoroscopy: {patient: {ct: c.vol, rotation: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],"
        " translation: [0, 0, 0]}}\n",
    // a bench scene with loads and a driven distal end
    "introducer: false\nproximal_end: clamped\ninstrument: " + kWire +
        "\ndistal_end: {hold: clamped, twist: held, tilt: {axis: [0, 0, 1]}}\nloads: {point_loads: [{force: [0, 0, "
        "0]}]}\nrollers: [{position: [0, 1, 0], radius: 0.01, displacement: {direction: [0, 1, 0]}}]\n",
    // several instruments with a procedure
    "vessel: {friction: 0.1, " + kTube + "}\ninstruments:\n  - {instrument: " + kWire +
        ", drive: {source: procedure}}\n  - {instrument: " + kStentSystem +
        ", drive: {source: procedure, initial_insertion: -0.1, limits: {}}}\n"
        "procedure:\n  branches: [{name: a, at: [0, 0, 0]}]\n  steps:\n"
        "    - {advance: w, until: {tip_in: tube}}\n    - {rotate: w, until: {turned: 1}}\n    - {wait: 1}\n"
        "    - {inflate: b, pressure: 1e6, for: 1}\n    - {inject: b, volume: 1e-6, rate: 1e-6}\n"
        "flow: {circulation: {outlets: {territories: [{branch: tube, share: 0.5}]}}}\n"
        "contrast: {injections: [{at: 0, volume: 1e-6, rate: 1e-6}]}\n",
};

/** Path of a key in a scene with one instrument. */
std::string shortPath(const std::string& path)
{
  const std::string layer = "instruments.N.";
  const bool is_short = path.rfind(layer + "instrument.", 0) == 0 || path.rfind(layer + "drive.", 0) == 0;
  return is_short ? path.substr(layer.size()) : path;
}

}  // namespace

std::vector<yaml::NumericKey> numericKeys()
{
  std::vector<yaml::NumericKey> keys;
  for (const std::string& text : kScenes)
  {
    const yaml::Node root = yaml::parseTree(text, "schema");
    Scene scene;
    scene.name = "schema";
    yaml::ReadingReport report;
    yaml::Reader reader(root, &report);
    visitScene(reader, scene);
    reader.finish();
    for (yaml::NumericKey& key : report.keys)
    {
      key.path = shortPath(key.path);
      if (std::none_of(keys.begin(), keys.end(),
                       [&key](const yaml::NumericKey& other) { return other.path == key.path; }))
        keys.push_back(key);
    }
  }
  std::stable_sort(keys.begin(), keys.end(),
                   [](const yaml::NumericKey& a, const yaml::NumericKey& b)
                   { return a.path.substr(0, a.path.find('.')) < b.path.substr(0, b.path.find('.')); });
  return keys;
}

std::string numericKeysTable()
{
  std::string table = "| key | unit | usual | accepted |\n|---|---|---|---|\n";
  for (const yaml::NumericKey& key : numericKeys())
    table += "| `" + key.path + "` | " + (key.unit.empty() ? "–" : key.unit) + " | " + key.usual + " | " +
             key.accepted + " |\n";
  return table;
}

}  // namespace endovascular_sim::scene
