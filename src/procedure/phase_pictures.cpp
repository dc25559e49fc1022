#include "procedure/phase_pictures.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "common/error.h"

namespace endovascular_sim::procedure
{

PhasePictures::PhasePictures(const scene::Scene& scene, const vessel::Vessel& vessel, const std::string& folder)
  : image_(scene, vessel), folder_(folder + "/fluoroscopy")
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
  image_.setView(view_);
  char name[32];
  std::snprintf(name, sizeof name, "/phase_%02d.png", ++images_);
  image_.write(simulation, wall, folder_ + name);
}

}  // namespace endovascular_sim::procedure
