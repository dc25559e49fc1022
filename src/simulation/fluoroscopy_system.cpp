#include "simulation/fluoroscopy_system.h"

#include <algorithm>
#include <utility>

#include "common/error.h"
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

fluoroscopy::CArmPose poseOf(const scene::FluoroscopyScene& scene)
{
  fluoroscopy::CArmPose pose;
  pose.primary_angle = scene.primary_angle;
  pose.secondary_angle = scene.secondary_angle;
  pose.source_to_detector = scene.source_to_detector;
  pose.source_to_patient = scene.source_to_patient;
  pose.isocentre = scene.isocentre.value_or(Eigen::Vector3d::Zero());
  pose.detector_width = scene.detector_width;
  pose.pixels = scene.pixels;
  return pose;
}

fluoroscopy::XRayScene surroundingsOf(const scene::FluoroscopyScene& scene, const fluoroscopy::MaterialLibrary& table)
{
  fluoroscopy::XRayScene result;
  result.tissue_attenuation = table.linear("soft_tissue", scene.energy);
  result.vessel_attenuation = table.contrast(scene.iodine, scene.energy);
  result.tissue_thickness = scene.tissue_thickness;
  return result;
}

/** Attenuation of the instruments' surroundings: contrast medium in a vessel, else tissue, else air [1/m]. */
double displaced(const scene::Scene& scene, const fluoroscopy::XRayScene& xray)
{
  if (scene.vessel)
    return xray.vessel_attenuation;
  return xray.tissue_thickness > 0.0 ? xray.tissue_attenuation : 0.0;
}

}  // namespace

FluoroscopySystem::FluoroscopySystem(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& table)
  : fluoroscope_(poseOf(xRayOf(scene)), surroundingsOf(xRayOf(scene), table))
{
  const double energy = xRayOf(scene).energy;
  const double less = displaced(scene, fluoroscope_.scene());
  for (const scene::DrivenInstrument& driven : scene.instruments)
    instruments_.emplace_back(driven.instrument, table, energy, less);
  filling_ = table.contrast(kBalloonIodine, energy) - less;
  metal_ = table.linear("steel", energy) - less;
}

std::vector<fluoroscopy::XRayWire> FluoroscopySystem::wires(const Simulation& simulation) const
{
  const auto first = simulation.state().position.begin() + simulation.state().first_node;
  const std::vector<Eigen::Vector3d> nodes(first, simulation.state().position.end());
  double furthest = simulation.hand(0).insertion;
  for (int k = 1; k < simulation.instruments(); ++k)
    furthest = std::max(furthest, simulation.hand(k).insertion);
  std::vector<fluoroscopy::XRayWire> wires;
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    instruments_[k].append(nodes, furthest - simulation.hand(k).insertion, wires);
    const intervention::Treatment* treatment = simulation.treatment(k);
    if (treatment == nullptr)
      continue;
    const intervention::RoundBody& balloon = treatment->load().balloon;
    if (!balloon.axis.empty())
      wires.push_back(fluoroscopy::balloonWire(balloon.axis, balloon.radii, filling_));
    if (treatment->stent() && !treatment->stent()->sleeve().axis.empty())
      for (fluoroscopy::XRayWire& strut : fluoroscopy::strutWires(
               intervention::stentStruts(treatment->stent()->sleeve()), treatment->stent()->strutThickness(), metal_))
        wires.push_back(std::move(strut));
  }
  return wires;
}

}  // namespace endovascular_sim::simulation
