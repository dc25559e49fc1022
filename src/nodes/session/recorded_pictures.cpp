#include "nodes/session/recorded_pictures.h"

#include <utility>
#include <vector>

#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include "common/error.h"
#include "common/text/format.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "fluoroscopy/image/png_writer.h"
#include "intervention/wall_displacement.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/image_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/session_bag.h"
#include "scene/file_search.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::nodes
{

std::string pictureName(std::uint64_t frame)
{
  return formatted("frame_%06llu.png", static_cast<unsigned long long>(frame));
}

RecordedPictures::RecordedPictures(const scene::Scene& scene, std::uint32_t interval, std::string folder)
  : has_images_(scene.record.x_ray_frames),
    interval_(interval),
    folder_(std::move(folder)),
    room_(scene, fluoroscopy::MaterialLibrary::load(scene::configFolder() + "/xray/materials.yaml")),
    states_({1.0 / scene.solver.time_step, scene.solver.time_step}, {}, true)
{
  loadPatient();
}

void RecordedPictures::loadPatient()
{
  if (room_.canLoadPatient())
    room_.loadPatient(simulation::kStillResolution);
}

void RecordedPictures::add(const BagMessage& message)
{
  if (!has_images_ && isTopic(message.topic, names::kFluoroscopyCameraInfo))
    addFrame(message.time);
  else if (!has_images_)
    addScene(message);
  else if (isTopic(message.topic, names::kFluoroscopyImage) && message.is<sensor_msgs::Image>() && isDue(frames_++))
  {
    const auto image = message.read<sensor_msgs::Image>();
    requireUsable(*image);
    if (image->encoding != sensor_msgs::image_encodings::MONO8 || image->step != image->width)
      return;
    fluoroscopy::writePng(folder_ + "/fluoroscopy/" + pictureName(frames_ - 1), static_cast<int>(image->width),
                          static_cast<int>(image->height), image->data);
    ++pictures_;
  }
}

/** Takes over what is imaged, as the node of fluoroscopy does. */
void RecordedPictures::addScene(const BagMessage& message)
{
  if (isTopic(message.topic, names::kRodStateVisual) && message.is<RodStateVisual>())
  {
    const auto rod = message.read<RodStateVisual>();
    simulation::ImagedInstruments instruments = imagedInstruments(*rod, room_.system().instruments().size());
    room_.follow(instruments.nodes);
    states_.addInstruments(rod->step + 1, std::move(instruments));
  }
  else if (isTopic(message.topic, names::kMotionState) && message.is<MotionState>())
  {
    const auto motion = message.read<MotionState>();
    states_.addMotion(motion->step + 1, {fromMessage(*motion), motion->diaphragm});
  }
  else if (isTopic(message.topic, names::kTreatmentVisual) && message.is<TreatmentVisual>())
  {
    const auto treatment = message.read<TreatmentVisual>();
    states_.addTreatment(treatment->step + 1, imagedTreatment(*treatment));
  }
  else if (isTopic(message.topic, names::kContrastState) && message.is<ContrastState>())
  {
    const auto contrast = message.read<ContrastState>();
    states_.addContrast(contrast->step + 1, mediumOf(*contrast));
  }
  else if (isTopic(message.topic, names::kCArmCommand) && message.is<CArm>())
  {
    const auto command = message.read<CArm>();
    const bool names_isocentre = command->view.empty() || !fromMessage(command->isocentre).isZero(0.0);
    room_.moveTo(toPose(*command, room_.gantry().target()), names_isocentre);
  }
  else if (isTopic(message.topic, names::kVesselMesh) && message.is<VesselMesh>() && wall_.vertices.empty())
  {
    wall_ = fromMessage(*message.read<VesselMesh>());
    room_.setVessel(wall_);
    loadPatient();
  }
  else if (isTopic(message.topic, names::kVesselCentreline) && message.is<VesselCentreline>())
  {
    const auto centreline = message.read<VesselCentreline>();
    room_.setCentreline(fromMessage(*centreline), lesionsFromMessage(*centreline));
    loadPatient();
  }
  else if (isTopic(message.topic, names::kWallDisplacement) && message.is<WallDisplacement>())
  {
    intervention::move(fromMessage(*message.read<WallDisplacement>(), wall_.vertices.size()), wall_.vertices);
    wall_moved_ = true;
  }
}

void RecordedPictures::addFrame(const ros::Time& time)
{
  if (gantry_time_ && time > *gantry_time_)
    room_.advance((time - *gantry_time_).toSec());
  gantry_time_ = time;
  if (!isDue(frames_++) || room_.awaitsVessel() || room_.awaitsPatient())
    return;
  if (std::exchange(wall_moved_, false))
    room_.setVessel(wall_);
  if (const std::optional<ImagedState> state = states_.take(false))
    room_.setState(*state);
  const fluoroscopy::Frame& frame = room_.draw(frames_ - 1, true).native;
  fluoroscopy::writePng(folder_ + "/fluoroscopy/" + pictureName(frames_ - 1), frame.pixels, frame.pixels, frame.image);
  ++pictures_;
}

}  // namespace endovascular_sim::nodes
