#include "session/still_image.h"

#include <optional>
#include <utility>

#include "common/error.h"
#include "fluoroscopy/gantry/view.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "scene/file_search.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::session
{

StillImage::StillImage(const scene::Scene& scene, std::shared_ptr<const fluoroscopy::VolumeProjection> patient)
  : system_(scene, fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml")),
    scene_pose_(system_.fluoroscope().geometry().pose()),
    pose_(scene_pose_),
    at_tip_(scene.fluoroscopy->follow_tip || !scene.fluoroscopy->isocentre)
{
  if (patient)
    system_.fluoroscope().setPatient(
        std::make_unique<fluoroscopy::ProgressiveProjection>(std::move(patient), simulation::kStillResolution));
}

void StillImage::setView(const std::string& name)
{
  const std::optional<fluoroscopy::View> view =
      name.empty() ? fluoroscopy::View{scene_pose_.primary_angle, scene_pose_.secondary_angle}
                   : fluoroscopy::parseView(name);
  if (!view)
    throw InputError("X-ray image", "view", fluoroscopy::unknownView(name));
  pose_.primary_angle = view->primary_angle;
  pose_.secondary_angle = view->secondary_angle;
}

const fluoroscopy::Frame& StillImage::frame(const simulation::Simulation& simulation,
                                            const geometry::TriangleMesh* wall)
{
  if (at_tip_)
    pose_.isocentre = simulation.state().position.back();
  system_.fluoroscope().setPose(pose_);
  if (wall != nullptr)
    system_.fluoroscope().setVessel(*wall);
  system_.fluoroscope().setMotion(simulation::bodyMotion(simulation));
  return system_.fluoroscope().render(system_.wires(simulation));
}

}  // namespace endovascular_sim::session
