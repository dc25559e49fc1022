#include "session/still_image.h"

#include <memory>
#include <optional>

#include "common/error.h"
#include "fluoroscopy/gantry/view.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "scene/file_search.h"
#include "session/contrast_picture.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::session
{

StillImage::StillImage(const World& world)
  : world_(world),
    system_(world.scene(), fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml")),
    scene_pose_(system_.fluoroscope().geometry().pose()),
    pose_(scene_pose_),
    at_tip_(world.scene().fluoroscopy->follow_tip || !world.scene().fluoroscopy->isocentre)
{
  if (world.patient().projection)
    system_.fluoroscope().setPatient(
        std::make_unique<fluoroscopy::ProgressiveProjection>(world.patient().projection, simulation::kStillResolution));
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
  setContrast(world_, simulation, system_);
  system_.fluoroscope().setMotion(simulation::bodyMotion(simulation));
  return system_.fluoroscope().render(system_.wires(simulation));
}

}  // namespace endovascular_sim::session
