#include "benchmark/x_ray/coronary_view.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "fluoroscopy/projection/coaxial_stack.h"
#include "scene/file_search.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kDetectorWidth = 0.3;          // m
constexpr double kPrimaryAngle = -0.5235988;    // RAO 30°
constexpr double kSecondaryAngle = -0.3490659;  // caudal 20°

int indexOf(const vessel::CentrelineTree& tree, const std::string& name)
{
  for (std::size_t k = 0; k < tree.branches.size(); ++k)
    if (tree.branches[k].name == name)
      return static_cast<int>(k);
  throw InputError("default anatomy", name, "the centreline has no such branch");
}

std::size_t nearestTo(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& point)
{
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < points.size(); ++k)
    if ((points[k] - point).norm() < (points[nearest] - point).norm())
      nearest = k;
  return nearest;
}

/** Points from the root to the end of a branch. */
std::vector<Eigen::Vector3d> fromRoot(const vessel::CentrelineTree& tree, int branch)
{
  std::vector<Eigen::Vector3d> path;
  for (int k = branch; k >= 0; k = tree.branches[static_cast<std::size_t>(k)].parent)
  {
    std::vector<Eigen::Vector3d> part = tree.branches[static_cast<std::size_t>(k)].points;
    if (!path.empty())
      part.resize(nearestTo(part, path.front()) + 1);
    path.insert(path.begin(), part.begin(), part.end());
  }
  return path;
}

scene::Scene pciScene()
{
  scene::Scene scene = scene::loadScene(scene::configFolder() + "/scenes/pci.yaml", {});
  scene.fluoroscopy->primary_angle = kPrimaryAngle;
  scene.fluoroscopy->secondary_angle = kSecondaryAngle;
  scene.fluoroscopy->detector_width = kDetectorWidth;
  return scene;
}

/** Every fourth point, and the last: about as far apart as the nodes of a simulated wire. */
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points)
{
  std::vector<Eigen::Vector3d> result;
  for (std::size_t k = 0; k + 1 < points.size(); k += 4)
    result.push_back(points[k]);
  result.push_back(points.back());
  return result;
}

}  // namespace

CoronaryView::CoronaryView()
  : scene(pciScene()), vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::centrelineUse(scene)))
{
  const vessel::CentrelineTree& tree = vessel.centreline;
  path = fromRoot(tree, indexOf(tree, "right_common_femoral"));
  std::reverse(path.begin(), path.end());
  const std::vector<Eigen::Vector3d> coronary = fromRoot(tree, indexOf(tree, "left_anterior_descending"));
  const Eigen::Vector3d ostium = tree.branches[static_cast<std::size_t>(indexOf(tree, "left_main"))].points.front();
  path.resize(nearestTo(path, ostium) + 1);
  path.insert(path.end(), coronary.begin() + static_cast<std::ptrdiff_t>(nearestTo(coronary, ostium)) + 1,
              coronary.end());
  path = thinned(path);
  centre = coronary[(nearestTo(coronary, ostium) + coronary.size()) / 2];
  scene.fluoroscopy->isocentre = centre;
}

simulation::FluoroscopySystem CoronaryView::system(int pixels)
{
  scene.fluoroscopy->pixels = pixels;
  simulation::FluoroscopySystem system(
      scene, fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml"));
  system.fluoroscope().setVessel(vessel.mesh);
  system.fluoroscope().setPatient(
      simulation::loadPatient(scene, vessel, simulation::sequenceResolution(scene.fluoroscopy->rate)).patient);
  return system;
}

std::vector<fluoroscopy::XRayWire> CoronaryView::wires(const simulation::FluoroscopySystem& system) const
{
  std::vector<double> behind;
  for (std::size_t k = 0; k < system.instruments().size(); ++k)
    behind.push_back(k == 0 ? 0.0 : 0.02 + 0.04 * static_cast<double>(k - 1));
  return {fluoroscopy::coaxialStack(path, system.instruments(), behind, {system.fluids()})};
}

}  // namespace endovascular_sim::benchmark
