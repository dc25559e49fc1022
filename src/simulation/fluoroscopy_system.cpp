#include "simulation/fluoroscopy_system.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/error.h"
#include "fluoroscopy/projection/coaxial_stack.h"
#include "fluoroscopy/projection/x_ray_treatment.h"
#include "intervention/stent_placement.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kBalloonIodine = 185.0;  // mgI/ml: contrast medium of 370 mgI/ml, diluted by half (assumed)

const scene::FluoroscopyScene& xRayOf(const scene::Scene& scene)
{
  if (!scene.fluoroscopy)
    throw InputError(scene.file, "fluoroscopy", "missing; add `fluoroscopy: {}` to render images");
  return *scene.fluoroscopy;
}

fluoroscopy::XRayScene techniqueOf(const scene::FluoroscopyScene& scene, std::uint64_t seed)
{
  fluoroscopy::XRayScene result;
  result.beam = {scene.tube_voltage, scene.aluminium, scene.copper, scene.energy};
  result.exposure.detector_dose = scene.detector_dose;
  result.exposure.rate = scene.rate;
  result.exposure.max_air_kerma_rate = scene.max_air_kerma_rate;
  result.display = {scene.edge_enhancement, scene.zoom, scene.inverted, scene.recursive_filter};
  result.tissue_thickness = scene.tissue_thickness;
  result.iodine = scene.iodine;
  result.seed = seed;
  return result;
}

/** X-ray wires of an instrument's balloon and stent, with the vessel at rest. */
void appendTreatment(const intervention::Treatment& treatment, const fluoroscopy::DeviceDensity& filling,
                     const fluoroscopy::DeviceDensity& metal, std::vector<fluoroscopy::XRayWire>& wires)
{
  const intervention::RoundBody& balloon = treatment.load().balloon;
  if (!balloon.axis.empty())
    wires.push_back(fluoroscopy::balloonWire(balloon.axis, balloon.radii, filling));
  if (treatment.stent() && !treatment.stent()->sleeve().axis.empty())
    for (fluoroscopy::XRayWire& strut : fluoroscopy::strutWires(intervention::stentStruts(treatment.stent()->sleeve()),
                                                                treatment.stent()->strutThickness(), metal))
      wires.push_back(std::move(strut));
}

}  // namespace

fluoroscopy::BodyMotion bodyMotion(const Simulation& simulation)
{
  if (simulation.motion() == nullptr)
    return {};
  const motion::MovingPatient& patient = simulation.motion()->patient();
  return {patient.map(), patient.diaphragm()};
}

FluoroscopySystem::FluoroscopySystem(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& library)
  : fluoroscope_(xRayOf(scene).pose(), techniqueOf(xRayOf(scene), scene.seed), library)
{
  const fluoroscopy::DeviceResponse& materials = fluoroscope_.materials();
  if (scene.vessel)
    fluids_ = fluoroscope_.vesselFluids();
  else if (xRayOf(scene).tissue_thickness > 0.0)
    fluids_ = fluoroscope_.tissueFluids();
  for (const scene::DrivenInstrument& driven : scene.instruments)
    instruments_.emplace_back(driven.instrument, materials);
  filling_ = materials.blood(kBalloonIodine) - fluids_.around;
  metal_ = materials.solid("steel") - fluids_.around;
}

std::vector<fluoroscopy::XRayWire> FluoroscopySystem::wires(const Simulation& simulation) const
{
  const auto first = simulation.state().position.begin() + simulation.state().first_node;
  const std::vector<Eigen::Vector3d> nodes(first, simulation.state().position.end());
  double furthest = simulation.hand(0).insertion;
  for (int k = 1; k < simulation.instruments(); ++k)
    furthest = std::max(furthest, simulation.hand(k).insertion);
  std::vector<double> behind;
  for (int k = 0; k < simulation.instruments(); ++k)
    behind.push_back(furthest - simulation.hand(k).insertion);
  std::vector<fluoroscopy::XRayWire> wires;
  wires.push_back(fluoroscopy::coaxialStack(nodes, instruments_, behind, {fluids_}));
  std::vector<fluoroscopy::XRayWire> treatment;
  for (int k = 0; k < simulation.instruments(); ++k)
    if (simulation.treatment(k) != nullptr)
      appendTreatment(*simulation.treatment(k), filling_, metal_, treatment);
  if (simulation.motion() != nullptr)
    fluoroscopy::moveWires(simulation.motion()->patient().map(), treatment);
  std::move(treatment.begin(), treatment.end(), std::back_inserter(wires));
  return wires;
}

}  // namespace endovascular_sim::simulation
