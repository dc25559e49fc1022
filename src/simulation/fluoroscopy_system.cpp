#include "simulation/fluoroscopy_system.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/error.h"
#include "fluoroscopy/projection/coaxial_stack.h"
#include "fluoroscopy/projection/x_ray_treatment.h"
#include "intervention/stent_placement.h"
#include "simulation/instrument_tip.h"

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
void appendTreatment(const intervention::Treatment& treatment, const FluoroscopySystem& system,
                     std::vector<fluoroscopy::XRayWire>& wires)
{
  const auto middle = [](const std::vector<Eigen::Vector3d>& axis) { return axis[axis.size() / 2]; };
  const intervention::RoundBody& balloon = treatment.load().balloon;
  if (!balloon.axis.empty())
    wires.push_back(fluoroscopy::balloonWire(balloon.axis, balloon.radii, system.fillingAt(middle(balloon.axis))));
  if (!treatment.stent() || treatment.stent()->sleeve().axis.empty())
    return;
  const intervention::RoundBody& sleeve = treatment.stent()->sleeve();
  for (fluoroscopy::XRayWire& strut : fluoroscopy::strutWires(
           intervention::stentStruts(sleeve), treatment.stent()->strutThickness(), system.metalAt(middle(sleeve.axis))))
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

ContrastMedium contrastMedium(const Simulation& simulation)
{
  ContrastMedium medium;
  if (simulation.contrast() == nullptr)
    return medium;
  if (simulation.blood() != nullptr && simulation.blood()->field() != nullptr)
    medium.cells = simulation.blood()->field()->iodine;
  const std::vector<double>& lumens = simulation.contrast()->lumens();
  if (std::any_of(lumens.begin(), lumens.end(), [](double iodine) { return iodine > 0.0; }))
    medium.instruments = lumens;
  return medium;
}

FluoroscopySystem::FluoroscopySystem(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& library)
  : scene_(scene), fluoroscope_(xRayOf(scene).pose(), techniqueOf(xRayOf(scene), scene.seed), library)
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

void FluoroscopySystem::setLumen(const vessel::CentrelineTree& centreline, const contrast::ContrastCells& cells,
                                 std::shared_ptr<const contrast::LumenCells> lumen)
{
  fluoroscope_.setLumen(lumen);
  lumen_ = std::move(lumen);
  finder_.emplace(centreline, cells);
  parts_.clear();
  lumens_.clear();
}

void FluoroscopySystem::setContrast(const ContrastMedium& medium)
{
  if (!medium.instruments.empty() && medium.instruments.size() != instruments_.size())
    throw InputError("X-ray scene", "contrast", "must have one concentration for each instrument, or none");
  fluoroscope_.setContrast(medium.cells);
  parts_ = medium.cells.empty() ? std::vector<double>{} : lumen_->partConcentrations(medium.cells);
  lumens_.clear();
  if (parts_.empty() && medium.instruments.empty())
    return;
  for (std::size_t k = 0; k < instruments_.size(); ++k)
    lumens_.push_back(fluoroscope_.blood(medium.instruments.empty() ? 0.0 : medium.instruments[k]));
}

/** Blood and contrast medium at a place of the resting vessel. */
fluoroscopy::DeviceDensity FluoroscopySystem::bloodAt(const Eigen::Vector3d& place) const
{
  const int cell = parts_.empty() ? -1 : finder_->at(place);
  if (cell < 0)
    return fluids_.around;
  const int part = lumen_->part_of_cell[static_cast<std::size_t>(cell)];
  return fluoroscope_.blood(parts_[static_cast<std::size_t>(part)]);
}

fluoroscopy::DeviceDensity FluoroscopySystem::fillingAt(const Eigen::Vector3d& place) const
{
  return parts_.empty() ? filling_ : filling_ + fluids_.around - bloodAt(place);
}

fluoroscopy::DeviceDensity FluoroscopySystem::metalAt(const Eigen::Vector3d& place) const
{
  return parts_.empty() ? metal_ : metal_ + fluids_.around - bloodAt(place);
}

fluoroscopy::XRayWire FluoroscopySystem::stack(const std::vector<Eigen::Vector3d>& nodes,
                                               const std::vector<double>& behind, const motion::MotionMap& map) const
{
  if (parts_.empty() || nodes.size() < 2)
    return fluoroscopy::coaxialStack(nodes, instruments_, behind, {fluids_}, lumens_);
  std::vector<Eigen::Vector3d> middles, rest;
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
    middles.emplace_back(0.5 * (nodes[k] + nodes[k + 1]));
  map.pullBack(middles, rest);
  std::vector<fluoroscopy::LocalFluids> fluids;
  for (const Eigen::Vector3d& place : rest)
    fluids.push_back({bloodAt(place), fluids_.lumen});
  return fluoroscopy::coaxialStack(nodes, instruments_, behind, fluids, lumens_);
}

void FluoroscopySystem::setHeart(const motion::HeartFrame& heart)
{
  if (!scene_.motion || (heart_ && fluoroscopy::sameRegion(*heart_, heart)))
    return;
  heart_ = heart;
  fluoroscope_.setPhases(
      std::make_shared<const fluoroscopy::PhaseGrid>(motion::PatientMotion(heart, scene_.motion->patient)));
}

std::vector<fluoroscopy::XRayWire> FluoroscopySystem::wires(const Simulation& simulation) const
{
  const auto first = simulation.state().position.begin() + firstInsertedNode(simulation);
  const std::vector<Eigen::Vector3d> nodes(first, simulation.state().position.end());
  double furthest = simulation.hand(0).insertion;
  for (int k = 1; k < simulation.instruments(); ++k)
    furthest = std::max(furthest, simulation.hand(k).insertion);
  std::vector<double> behind;
  for (int k = 0; k < simulation.instruments(); ++k)
    behind.push_back(furthest - simulation.hand(k).insertion);
  std::vector<fluoroscopy::XRayWire> wires;
  wires.push_back(stack(nodes, behind, bodyMotion(simulation).map()));
  std::vector<fluoroscopy::XRayWire> treatment;
  for (int k = 0; k < simulation.instruments(); ++k)
    if (simulation.treatment(k) != nullptr)
      appendTreatment(*simulation.treatment(k), *this, treatment);
  if (simulation.motion() != nullptr)
    fluoroscopy::moveWires(simulation.motion()->patient().map(), treatment);
  std::move(treatment.begin(), treatment.end(), std::back_inserter(wires));
  return wires;
}

}  // namespace endovascular_sim::simulation
