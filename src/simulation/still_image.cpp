#include "simulation/still_image.h"

#include <optional>
#include <utility>

#include "fluoroscopy/gantry/view.h"
#include "fluoroscopy/image/png_writer.h"
#include "scene/yaml/file_search.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::simulation
{

StillImage::StillImage(const scene::Scene& scene, const vessel::Vessel& vessel)
  : system_(scene, fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml")),
    at_tip_(scene.fluoroscopy->follow_tip || !scene.fluoroscopy->isocentre)
{
  XRayPatient loaded = loadPatient(scene, vessel, kStillResolution);
  notes_ = std::move(loaded.notes);
  if (loaded.patient)
    system_.fluoroscope().setPatient(std::move(loaded.patient));
}

void StillImage::setView(const std::string& name)
{
  const std::optional<fluoroscopy::View> view = fluoroscopy::parseView(name);
  if (!view)
    return;
  fluoroscopy::CArmPose pose = system_.fluoroscope().geometry().pose();
  pose.primary_angle = view->primary_angle;
  pose.secondary_angle = view->secondary_angle;
  system_.fluoroscope().setPose(pose);
}

void StillImage::write(const Simulation& simulation, const geometry::TriangleMesh& wall, const std::string& file)
{
  fluoroscopy::Fluoroscope& fluoroscope = system_.fluoroscope();
  if (at_tip_)
  {
    fluoroscopy::CArmPose pose = fluoroscope.geometry().pose();
    pose.isocentre = simulation.state().position.back();
    fluoroscope.setPose(pose);
  }
  fluoroscope.setVessel(wall);
  const fluoroscopy::Frame& frame = fluoroscope.render(system_.wires(simulation));
  fluoroscopy::writePng(file, frame.pixels, frame.pixels, frame.image);
}

}  // namespace endovascular_sim::simulation
