#include "scene/model/scene.h"
#include "scene/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "scene/file_search.h"
#include "scene/scene_vessel.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kScenes = std::string(PROJECT_DIR) + "/config/scenes/";
const std::string kBench = TEST_DATA_DIR "/scenes/good_bench.yaml";

using Names = std::vector<std::string>;

/** Creates an empty mesh file. Loading a scene requires the file to exist but does not read it. */
std::string someMesh()
{
  const std::string path = (std::filesystem::temp_directory_path() / "endovascular_sim_scene_test.stl").string();
  std::ofstream(path) << "solid\n";
  return path;
}

std::string text(const Eigen::MatrixXd& matrix)
{
  std::ostringstream stream;
  stream << std::hexfloat << matrix.format(Eigen::IOFormat(Eigen::FullPrecision));
  return stream.str();
}

void expectSameWire(const instrument::Instrument& a, const instrument::Instrument& b)
{
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.materials, b.materials);
  ASSERT_EQ(a.wire.sections.size(), b.wire.sections.size());
  for (std::size_t k = 0; k < a.wire.sections.size(); ++k)
  {
    const rod::Section& p = a.wire.sections[k];
    const rod::Section& q = b.wire.sections[k];
    EXPECT_EQ(p.length, q.length);
    EXPECT_EQ(p.bending_stiffness, q.bending_stiffness);
    EXPECT_EQ(p.torsional_stiffness, q.torsional_stiffness);
    EXPECT_EQ(p.axial_stiffness, q.axial_stiffness);
    EXPECT_EQ(p.radius, q.radius);
    EXPECT_EQ(p.density, q.density);
    EXPECT_EQ(std::isnan(p.friction), std::isnan(q.friction));
    EXPECT_EQ(p.rest_curvature, q.rest_curvature);
  }
}

/** Compares all values of two scenes except the file name. The resolved text contains all of them, so equal texts
 *  complete the check. */
void expectSameScene(const Scene& a, const Scene& b)
{
  EXPECT_EQ(a.resolved_yaml, b.resolved_yaml);
  EXPECT_EQ(a.hash(), b.hash());
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.duration, b.duration);
  EXPECT_EQ(a.introducer, b.introducer);
  EXPECT_EQ(a.haptic_device, b.haptic_device);
  EXPECT_EQ(a.proximal_end, b.proximal_end);
  EXPECT_EQ(a.distal_end, b.distal_end);
  EXPECT_EQ(a.distal.twist_held, b.distal.twist_held);
  EXPECT_EQ(text(a.distal.direction), text(b.distal.direction));
  EXPECT_EQ(text(a.distal.tilt_axis), text(b.distal.tilt_axis));
  ASSERT_EQ(a.vessel.has_value(), b.vessel.has_value());
  if (a.vessel)
  {
    EXPECT_EQ(a.vessel->mesh, b.vessel->mesh);
    EXPECT_EQ(a.vessel->anatomy, b.vessel->anatomy);
    EXPECT_EQ(a.vessel->unit, b.vessel->unit);
    EXPECT_EQ(a.vessel->friction, b.vessel->friction);
    EXPECT_EQ(a.vessel->stiffness, b.vessel->stiffness);
    ASSERT_EQ(a.vessel->friction_regions.size(), b.vessel->friction_regions.size());
    for (std::size_t k = 0; k < a.vessel->friction_regions.size(); ++k)
    {
      EXPECT_EQ(text(a.vessel->friction_regions[k].centre), text(b.vessel->friction_regions[k].centre));
      EXPECT_EQ(a.vessel->friction_regions[k].radius, b.vessel->friction_regions[k].radius);
      EXPECT_EQ(a.vessel->friction_regions[k].friction, b.vessel->friction_regions[k].friction);
    }
    ASSERT_EQ(a.vessel->lesions.size(), b.vessel->lesions.size());
    for (std::size_t k = 0; k < a.vessel->lesions.size(); ++k)
    {
      const vessel::Lesion& x = a.vessel->lesions[k];
      const vessel::Lesion& y = b.vessel->lesions[k];
      EXPECT_EQ(x.branch, y.branch);
      EXPECT_EQ(std::isnan(x.from_start), std::isnan(y.from_start));
      EXPECT_TRUE(std::isnan(x.from_start) ? x.fraction == y.fraction : x.from_start == y.from_start);
      EXPECT_EQ(x.length, y.length);
      EXPECT_EQ(x.grade, y.grade);
      EXPECT_EQ(x.eccentricity, y.eccentricity);
      EXPECT_EQ(x.angle, y.angle);
    }
    EXPECT_EQ(text(a.vessel->transform.matrix()), text(b.vessel->transform.matrix()));
  }
  EXPECT_EQ(text(a.entry.position), text(b.entry.position));
  EXPECT_EQ(text(a.entry.direction), text(b.entry.direction));
  EXPECT_EQ(text(a.entry.up), text(b.entry.up));
  expectSameWire(a.instruments.front().instrument, b.instruments.front().instrument);
  for (int i = 0; i < 200; ++i)
  {
    EXPECT_EQ(a.instruments.front().drive.insertionAt(0.1 * i), b.instruments.front().drive.insertionAt(0.1 * i));
    EXPECT_EQ(a.instruments.front().drive.rotationAt(0.1 * i), b.instruments.front().drive.rotationAt(0.1 * i));
    EXPECT_EQ(a.distal.displacement.at(0.1 * i), b.distal.displacement.at(0.1 * i));
    EXPECT_EQ(a.distal.tilt.at(0.1 * i), b.distal.tilt.at(0.1 * i));
    EXPECT_EQ(a.distal.rotation.at(0.1 * i), b.distal.rotation.at(0.1 * i));
  }
}

TEST(Scene, IsReproducedByItsResolvedTextForAllConfigFiles)
{
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes))
  {
    const std::string file = entry.path().string();
    const std::string name = entry.path().stem().string();
    Names overrides;
    if (name == "peer_wire" || name == "mesh" || name == "pci_real" || name == "three_instruments")
      overrides = {"vessel.mesh=" + someMesh()};
    const Scene scene = loadScene(file, overrides);
    EXPECT_EQ(scene.name, name);
    EXPECT_EQ(scene.file, file);
    expectSameScene(scene, parseScene(scene.resolved_yaml, file));
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST(Scene, AcceptsSurfaceNamesAndFrictionRegions)
{
  const Scene scene =
      loadScene(kScenes + "tube.yaml", {"vessel.friction=hydrophilic", "instrument.sections.0.friction=ptfe",
                                        "vessel.friction_regions=[{centre: [0, 0, 0.1], radius: 0.02, friction: bare},"
                                        " {centre: [0, 0, 0.11], radius: 0.01, friction: 0.4}]"});
  EXPECT_EQ(scene.vessel->friction, 0.035);
  EXPECT_EQ(scene.instruments.front().instrument.wire.sections[0].friction, 0.115);
  const contact::WallLaw law = wallLaw(*scene.vessel);
  EXPECT_EQ(law.frictionAt({0.0, 0.0, 0.0}), 0.035);
  EXPECT_EQ(law.frictionAt({0.0, 0.0, 0.09}), 0.25);
  EXPECT_EQ(law.frictionAt({0.0, 0.0, 0.11}), 0.4);  // the last of two overlapping regions applies
  expectSameScene(scene, parseScene(scene.resolved_yaml, scene.file));
}

TEST(Scene, ReadsLesions)
{
  const Scene scene = loadScene(
      kScenes + "tube.yaml", {"vessel.lesions=[{branch: tube, from_start: 0.05, length: 0.01, grade: 0.6},"
                              " {branch: tube, fraction: 0.7, length: 0.01, grade: 0.5, eccentricity: 1, angle: 2}]"});
  expectSameScene(scene, parseScene(scene.resolved_yaml, scene.file));
  const vessel::Vessel vessel = buildVessel(*scene.vessel, scene.entry, scene.file);
  ASSERT_EQ(vessel.lesions.size(), 2U);
  for (const vessel::PlacedLesion& placed : vessel.lesions)
    EXPECT_NEAR(placed.narrowed_diameter / placed.healthy_diameter, 1.0 - placed.lesion.grade, 0.01);
}

TEST(Scene, RetainsAllBitsOfANumberInItsResolvedText)
{
  const double awkward = 0.1 + 0.2;
  std::ostringstream override_text;
  override_text.precision(17);
  override_text << "duration=" << awkward;
  const Scene scene =
      loadScene(kBench, {override_text.str(), "entry.direction=[0.3, -0.4, 0.7]", "seed=18446744073709551615"});
  const Scene again = parseScene(scene.resolved_yaml, "recording");
  EXPECT_EQ(again.duration, awkward);
  EXPECT_EQ(again.seed, 18446744073709551615ULL);
  expectSameScene(scene, again);
}

TEST(Scene, OfARecordingDoesNotRequireTheFilesOfTheVessel)
{
  const std::string mesh = someMesh();
  const Scene scene = loadScene(kScenes + "mesh.yaml", {"vessel.mesh=" + mesh});
  std::filesystem::remove(mesh);
  EXPECT_THROW(parseScene(scene.resolved_yaml, "session.bag"), InputError);
  EXPECT_EQ(parseRecordedScene(scene.resolved_yaml, "session.bag").hash(), scene.hash());
}

TEST(Scene, RejectsANameThatIsNoFileName)
{
  for (const char* name : {"'../tube'", "'a name'", "'.hidden'", "''", "'a/b'"})
    EXPECT_THROW(loadScene(kBench, {std::string("name=") + name}), InputError) << name;
  EXPECT_EQ(loadScene(kBench, {"name=tube_2-b.1"}).name, "tube_2-b.1");
}

TEST(Scene, HashDependsOnTheValuesAndNotOnTheNotation)
{
  const std::uint64_t hash = loadScene(kBench).hash();
  EXPECT_EQ(loadScene(kBench, {"duration=1.0e0"}).hash(), hash);
  EXPECT_EQ(loadScene(kBench, {"solver.time_step=1e-3"}).hash(), hash);
  EXPECT_EQ(loadScene(kBench, {"vessel=none"}).hash(), hash);
  EXPECT_NE(loadScene(kBench, {"duration=1.001"}).hash(), hash);
  EXPECT_NE(loadScene(kBench, {"seed=1"}).hash(), hash);
  EXPECT_NE(loadScene(kBench, {"instrument.sections.0.friction=0.1"}).hash(), hash);
}

TEST(Scene, HashDoesNotDependOnThePathOfThePackage)
{
  const Scene scene = loadScene(kScenes + "straight_wire.yaml");
  EXPECT_EQ(scene.resolved_yaml.find(PROJECT_DIR), std::string::npos);
}

TEST(Scene, AppliesOverridesInOrderAndByListIndex)
{
  const Scene scene = loadScene(kScenes + "straight_wire.yaml",
                                {"instrument=instruments/peer_j_wire.yaml", "instrument.sections.1.radius=3e-4",
                                 "drive.speed=0.01", "drive.speed=0.02", "loads={gravity: [0, 0, -9.81]}"});
  ASSERT_EQ(scene.instruments.front().instrument.wire.sections.size(), 2U);
  EXPECT_EQ(scene.instruments.front().instrument.wire.sections[1].radius, 3e-4);
  EXPECT_EQ(scene.instruments.front().drive.speed, 0.02);
  EXPECT_EQ(scene.loads.gravity.z(), -9.81);
}

/** Restores ENDOVASCULAR_DATA_DIR for the following tests. */
class DataFolderAsItWas
{
public:
  DataFolderAsItWas() : was_(std::getenv(kName) != nullptr ? std::getenv(kName) : "") {}
  ~DataFolderAsItWas() { was_.empty() ? unsetenv(kName) : setenv(kName, was_.c_str(), 1); }

  static constexpr const char* kName = "ENDOVASCULAR_DATA_DIR";

private:
  std::string was_;
};

TEST(Scene, SearchesPathsNextToTheSceneInTheConfigFolderAndInTheDataFolder)
{
  const DataFolderAsItWas as_it_was;
  const std::string mesh = someMesh();
  const Names entry = {"vessel={mesh: endovascular_sim_scene_test.stl, unit: 1, friction: 0}",
                       "entry={position: [0,0,0], direction: [0,0,1]}"};
  setenv(DataFolderAsItWas::kName, std::filesystem::temp_directory_path().c_str(), 1);
  EXPECT_EQ(std::filesystem::path(loadScene(kBench, entry).vessel->mesh),
            std::filesystem::path(mesh).lexically_normal());
  unsetenv(DataFolderAsItWas::kName);
  EXPECT_THROW(loadScene(kBench, entry), InputError);
  EXPECT_NO_THROW(loadScene(kBench, {"instrument=instruments/peer_j_wire.yaml"}));
  EXPECT_NO_THROW(loadScene(kBench, {"instrument=../../../config/instruments/peer_j_wire.yaml"}));
}

TEST(Scene, RequiresOnlyTheNodesOfItsParts)
{
  EXPECT_EQ(requiredNodes(loadScene(kBench)), (Names{"rod_dynamics", "session"}));
  EXPECT_EQ(requiredNodes(loadScene(kScenes + "tube.yaml")),
            (Names{"vessel_server", "rod_dynamics", "contact", "session"}));
  EXPECT_EQ(requiredNodes(loadScene(kBench, {"fluoroscopy={}", "haptic_device=true"})),
            (Names{"rod_dynamics", "haptic_device", "fluoroscopy", "session"}));
}

TEST(Scene, OrientsAMeshByHeadAndLeft)
{
  const Scene scene = loadScene(
      kBench, {"vessel={mesh: " + someMesh() + ", unit: 0.001, friction: 0, head: [-1, 0, 0], left: [0, 0, 1]}",
               "entry={position: [0,0,0], direction: [0,0,1]}"});
  const Eigen::Matrix3d rotation = scene.vessel->transform.linear();
  EXPECT_EQ(rotation * Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(rotation * Eigen::Vector3d(0, 0, 1), Eigen::Vector3d::UnitX());
  EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12);
}

TEST(Scene, OfTheReferenceSimulatorHasItsWireAndMotion)
{
  const Scene scene = loadScene(kScenes + "peer_wire.yaml", {"vessel.mesh=" + someMesh()});
  const rod::Wire& wire = scene.instruments.front().instrument.wire;
  EXPECT_NEAR(wire.length(), 0.450, 1e-8);
  EXPECT_NEAR(wire.curvedTipLength(), 12.1e-3 * 0.4 * M_PI, 1e-8);
  EXPECT_NEAR(wire.sections[0].bending_stiffness, 2463e-6, 1e-6);
  EXPECT_NEAR(wire.sections[1].bending_stiffness, 200e-6, 1e-6);
  // The curvature vector κb = ω₁ d2 − ω₂ d1 is +d1/12.1 mm.
  EXPECT_NEAR(wire.sections[1].rest_curvature.x(), 0.0, 1e-12);
  EXPECT_NEAR(wire.sections[1].rest_curvature.y(), -1.0 / 12.1e-3, 1e-9);
  // d1 = direction × (0, 0, −1).
  EXPECT_TRUE(scene.entry.up.normalized().isApprox(scene.entry.direction.cross(-Eigen::Vector3d::UnitZ()), 1e-12));
  EXPECT_NEAR(scene.instruments.front().drive.rotationAt(1.3), 2.0 * std::sin(1.3), 1e-12);
  EXPECT_NEAR(scene.instruments.front().drive.insertionAt(2.0), 0.0042 + 0.07, 1e-12);
  EXPECT_EQ(scene.instruments.front().drive.insertionAt(100.0), 0.0042 + 0.4);
  EXPECT_EQ(scene.sampling.nodes, 240);
  EXPECT_TRUE(std::isinf(scene.vessel->stiffness));
}

TEST(DriveProfile, IsLinearBetweenItsPointsAndConstantBeyondThem)
{
  DriveProfile profile;
  profile.points = {{1.0, 2.0}, {3.0, 6.0}, {4.0, 0.0}};
  EXPECT_EQ(profile.at(-5.0), 2.0);
  EXPECT_EQ(profile.at(1.0), 2.0);
  EXPECT_EQ(profile.at(2.0), 4.0);
  EXPECT_EQ(profile.at(3.0), 6.0);
  EXPECT_EQ(profile.at(3.5), 3.0);
  EXPECT_EQ(profile.at(4.0), 0.0);
  EXPECT_EQ(profile.at(9.0), 0.0);
}

TEST(DriveProfile, AddsTheSineToThePoints)
{
  DriveProfile profile;
  profile.points = {{0.0, 1.0}, {1.0, 2.0}};
  profile.amplitude = 0.5;
  profile.frequency = 2.0;
  profile.phase = 0.3;
  for (const double t : {0.0, 0.1, 0.77, 3.0})
    EXPECT_NEAR(profile.at(t), 1.0 + std::min(t, 1.0) + 0.5 * std::sin(4.0 * M_PI * t + 0.3), 1e-14);
  EXPECT_EQ(DriveProfile().at(1.0), 0.0);
}

TEST(DriveScene, AddsTheInitialValuesToItsProfiles)
{
  DriveScene drive;
  drive.source = DriveSource::kScript;
  drive.initial_insertion = 0.01;
  drive.initial_rotation = 0.2;
  drive.insertion.points = {{0.0, 0.0}, {1.0, 0.1}};
  drive.rotation.points = {{0.0, 1.0}};
  EXPECT_NEAR(drive.insertionAt(0.5), 0.06, 1e-15);
  EXPECT_NEAR(drive.rotationAt(7.0), 1.2, 1e-15);
  drive.source = DriveSource::kNone;
  EXPECT_EQ(drive.insertionAt(0.5), 0.01);
  EXPECT_EQ(drive.rotationAt(0.5), 0.2);
}

/** Keys of a resolved scene, i.e. the words before a colon. */
std::vector<std::string> keysOf(const std::string& yaml)
{
  std::vector<std::string> keys;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t begin = line.find_first_not_of(" -");
    keys.push_back(line.substr(begin, line.find(':') - begin));
  }
  return keys;
}

TEST(Scene, HasAllKeysInItsDocumentation)
{
  std::ifstream file(std::string(PROJECT_DIR) + "/docs/SCENES.md");
  std::ostringstream docs;
  docs << file.rdbuf();
  const std::string tube =
      loadScene(kScenes + "tube.yaml",
                {"fluoroscopy={isocentre: [0,0,0]}", "instrument.sections.0.friction=0.1",
                 "vessel.friction_regions=[{centre: [0,0,0], radius: 1, friction: 1}]",
                 "vessel.lesions=[{branch: tube, length: 0.01, grade: 0.5}]", "loads.point_loads=[{torque: 1}]"})
          .resolved_yaml;
  const std::string mesh = loadScene(kScenes + "mesh.yaml", {"vessel.mesh=" + someMesh()}).resolved_yaml;
  const std::string robot = loadScene(kScenes + "robot.yaml").resolved_yaml;
  std::vector<std::string> keys = keysOf(tube + mesh + robot);
  for (const char* input :
       {"head", "left", "anatomy", "centreline_end", "young_modulus", "shear_modulus", "poisson_ratio", "tip", "shape",
        "angle", "straight", "from_start", "direction", "insertion", "speed", "travel"})
    keys.emplace_back(input);
  for (const std::string& key : keys)
    EXPECT_NE(docs.str().find("`" + key + "`"), std::string::npos) << key;
}

TEST(SceneAnatomy, AWordNamesAnAnatomyOfThePackage)
{
  const std::string entry = "entry: {centreline_end: trunk}\ninstrument: {use: guidewire_035_j}\n";
  const Scene scene = parseScene("vessel: {anatomy: fork, friction: 0.1}\n" + entry, "scene.yaml");
  EXPECT_EQ(scene.vessel->anatomy, configFolder() + "/anatomies/fork.yaml");
  EXPECT_EQ(parseScene("vessel: {anatomy: anatomies/fork.yaml, friction: 0.1}\n" + entry, "scene.yaml").vessel->anatomy,
            scene.vessel->anatomy);
  const std::string message =
      inputErrorOf([&] { parseScene("vessel: {anatomy: forks, friction: 0.1}\n" + entry, "scene.yaml"); });
  EXPECT_NE(message.find("vessel.anatomy (line 1): no anatomy \"forks\"; known: "), std::string::npos) << message;
  EXPECT_NE(message.find("fork, natural, plain"), std::string::npos) << message;
}

}  // namespace
}  // namespace endovascular_sim::scene
