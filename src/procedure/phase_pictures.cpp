#include "procedure/phase_pictures.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "common/error.h"
#include "fluoroscopy/png_writer.h"
#include "scene/yaml/file_search.h"

namespace endovascular_sim::procedure
{

PhasePictures::PhasePictures(const scene::Scene& scene, const std::string& folder)
  : room_(scene, fluoroscopy::AttenuationTable::load(scene::configFolder() + "/xray/attenuation.yaml")),
    folder_(folder + "/fluoroscopy")
{
  std::error_code refused;
  std::filesystem::create_directories(folder_, refused);
  if (refused)
    throw InputError(folder_, "", "cannot be made; choose a folder that can be written to");
}

void PhasePictures::look(const simulation::Simulation& simulation, const Operator& person,
                         const geometry::TriangleMesh& wall)
{
  if (over_ || person.records().empty())
    return;
  const std::string& phase = person.records().back().phase;
  over_ = person.progress() != Progress::kRunning;
  if (over_ || (!phase_.empty() && phase != phase_))
    take(simulation, wall);
  phase_ = phase;
}

void PhasePictures::take(const simulation::Simulation& simulation, const geometry::TriangleMesh& wall)
{
  fluoroscopy::CArmPose pose = room_.fluoroscope().geometry().pose();
  pose.isocentre = simulation.state().position.back();
  room_.fluoroscope().setPose(pose);
  room_.fluoroscope().setVessel(wall);
  const fluoroscopy::Frame& frame = room_.fluoroscope().render(room_.wires(simulation));
  char name[32];
  std::snprintf(name, sizeof name, "/phase_%02d.png", ++taken_);
  fluoroscopy::writePng(folder_ + name, frame.pixels, frame.pixels, frame.image);
}

}  // namespace endovascular_sim::procedure
