#include "session/x_ray_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "fluoroscopy/gantry/view.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "scene/file_search.h"
#include "session/contrast_picture.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::session
{
namespace
{

const scene::FluoroscopyScene& xRayOf(const scene::Scene& scene)
{
  if (!scene.fluoroscopy)
    throw InputError(scene.file, "fluoroscopy", "missing; add `fluoroscopy: {}` to render images");
  return *scene.fluoroscopy;
}

void setView(const std::string& name, fluoroscopy::Fluoroscope& fluoroscope)
{
  if (name.empty())
    return;
  const std::optional<fluoroscopy::View> view = fluoroscopy::parseView(name);
  if (!view)
    throw InputError("X-ray run", "view", fluoroscopy::unknownView(name));
  fluoroscopy::CArmPose pose = fluoroscope.geometry().pose();
  pose.primary_angle = view->primary_angle;
  pose.secondary_angle = view->secondary_angle;
  fluoroscope.setPose(pose);
}

/** Middle of the box around a vessel. */
Eigen::Vector3d middleOf(const geometry::TriangleMesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  return box.center();
}

}  // namespace

std::uint64_t stepsUntil(double time, double time_step)
{
  return static_cast<std::uint64_t>(std::ceil(time / time_step - 1e-6));
}

XRayRun::Plane::Plane(const World& world, const std::string& view, int detector)
  : system(world.scene(), fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml")),
    angiography(system.fluoroscope(), detector)
{
  setView(view, system.fluoroscope());
  if (world.patient().projection)
    system.fluoroscope().setPatient(std::make_unique<fluoroscopy::ProgressiveProjection>(
        world.patient().projection, simulation::sequenceResolution(world.scene().fluoroscopy->rate)));
}

XRayRun::XRayRun(const World& world, const XRayRunSettings& settings)
  : world_(world),
    pulses_(xRayOf(world.scene()).rate, world.scene().solver.time_step),
    mask_frames_(static_cast<std::uint64_t>(std::max(settings.mask_frames, 0)))
{
  if (settings.roadmap_at && settings.mask_frames == 0)
    throw InputError("X-ray run", "roadmap", "needs a run of DSA before it; give the frames of its mask");
  if (settings.roadmap_at)
    first_of_roadmap_ = pulses_.firstFrom(stepsUntil(*settings.roadmap_at, world.scene().solver.time_step));
  if (settings.views.empty() || settings.views.size() > 2)
    throw InputError("X-ray run", "views",
                     "has " + std::to_string(settings.views.size()) + " views; give one, or two of a biplane system");
  for (const std::string& view : settings.views)
  {
    Plane& plane = planes_.emplace_back(world, view, static_cast<int>(planes_.size()));
    if (settings.mask_frames != 0)
      plane.angiography.begin(fluoroscopy::XRayMode::kSubtraction, settings.mask_frames);
    plane.angiography.setShift(settings.shift);
  }
}

void XRayRun::requireFrames(std::uint64_t first, std::uint64_t last) const
{
  const auto time = [this](std::uint64_t pulse)
  { return static_cast<double>(pulses_.stepOf(pulse)) * world_.scene().solver.time_step; };
  if (mask_frames_ > 0 && last < first + mask_frames_)
    throw InputError(
        "X-ray run", "dsa",
        formatted("the mask takes %llu frames, but the run has %llu; give fewer, or a longer run",
                  static_cast<unsigned long long>(mask_frames_), static_cast<unsigned long long>(last - first + 1)));
  if (first_of_roadmap_ && (*first_of_roadmap_ <= first + mask_frames_ || *first_of_roadmap_ > last))
    throw InputError("X-ray run", "roadmap",
                     formatted("begins at %g s, but must begin after the first frame of DSA, at %g s, and by %g s",
                               time(*first_of_roadmap_), time(first + mask_frames_), time(last)));
}

/** Places the isocentre as the node of fluoroscopy does. */
void XRayRun::place(const Session& session)
{
  placed_ = true;
  const scene::FluoroscopyScene& scene = *world_.scene().fluoroscopy;
  if (scene.isocentre && !scene.follow_tip)
    return;
  const bool at_tip = scene.follow_tip || session.wall().vertices.empty();
  for (Plane& plane : planes_)
  {
    fluoroscopy::CArmPose pose = plane.system.fluoroscope().geometry().pose();
    pose.isocentre = at_tip ? session.simulation().state().position.back() : middleOf(session.wall());
    plane.system.fluoroscope().setPose(pose);
  }
}

void XRayRun::draw(const Session& session)
{
  const simulation::Simulation& simulation = session.simulation();
  if (!isDue(simulation))
    throw std::logic_error("XRayRun: no pulse is given at step " + std::to_string(simulation.steps()));
  if (!placed_)
    place(session);
  const std::uint64_t wall = session.wallVersion();
  const std::uint64_t pulse = pulses_.newestAt(simulation.steps());
  for (Plane& plane : planes_)
  {
    fluoroscopy::Fluoroscope& fluoroscope = plane.system.fluoroscope();
    if (wall_ != wall)
      fluoroscope.setVessel(session.wall());
    if (simulation.motion() != nullptr)
      plane.system.setHeart(simulation.motion()->patient().map().frame());
    fluoroscope.setMotion(simulation::bodyMotion(simulation));
    setContrast(world_, simulation, plane.system);
    if (first_of_roadmap_ && pulse >= *first_of_roadmap_ &&
        plane.angiography.mode() == fluoroscopy::XRayMode::kSubtraction)
      plane.angiography.begin(fluoroscopy::XRayMode::kRoadmap);
    plane.angiography.draw(pulse, plane.system.wires(simulation), true, true);
  }
  wall_ = wall;
}

}  // namespace endovascular_sim::session
