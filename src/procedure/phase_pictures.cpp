#include "procedure/phase_pictures.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "common/error.h"
#include "fluoroscopy/gantry/view.h"
#include "fluoroscopy/image/png_writer.h"
#include "scene/yaml/file_search.h"

namespace endovascular_sim::procedure
{

PhasePictures::PhasePictures(const scene::Scene& scene, const std::string& folder)
  : fluoroscopy_(scene, fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml")),
    folder_(folder + "/fluoroscopy")
{
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error)
    throw InputError(folder_, "", "cannot be created; choose a writable folder");
}

void PhasePictures::update(const simulation::Simulation& simulation, const Operator& scripted_operator,
                           const geometry::TriangleMesh& wall)
{
  if (finished_ || scripted_operator.records().empty())
    return;
  const StepRecord& step = scripted_operator.records().back();
  finished_ = scripted_operator.progress() != Progress::kRunning;
  if (finished_)
    view_ = step.view;
  if (finished_ || (!phase_.empty() && step.phase != phase_))
    writeImage(simulation, wall);
  phase_ = step.phase;
  view_ = step.view;
}

void PhasePictures::writeImage(const simulation::Simulation& simulation, const geometry::TriangleMesh& wall)
{
  fluoroscopy::CArmPose pose = fluoroscopy_.fluoroscope().geometry().pose();
  if (const std::optional<fluoroscopy::View> view = fluoroscopy::parseView(view_))
  {
    pose.primary_angle = view->primary_angle;
    pose.secondary_angle = view->secondary_angle;
  }
  pose.isocentre = simulation.state().position.back();
  fluoroscopy_.fluoroscope().setPose(pose);
  fluoroscopy_.fluoroscope().setVessel(wall);
  const fluoroscopy::Frame& frame = fluoroscopy_.fluoroscope().render(fluoroscopy_.wires(simulation));
  char name[32];
  std::snprintf(name, sizeof name, "/phase_%02d.png", ++images_);
  fluoroscopy::writePng(folder_ + name, frame.pixels, frame.pixels, frame.image);
}

}  // namespace endovascular_sim::procedure
