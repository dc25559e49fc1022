#include "nodes/fluoroscopy/x_ray_room.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>

#include "common/error.h"
#include "fluoroscopy/projection/x_ray_treatment.h"
#include "intervention/stent_placement.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::nodes
{

XRayRoom::XRayRoom(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& library)
  : scene_(scene),
    system_(scene_, library),
    fluoroscope_(system_.fluoroscope()),
    angiography_(fluoroscope_),
    gantry_(scene_.fluoroscopy->gantry, fluoroscope_.geometry().pose()),
    needs_patient_(scene_.fluoroscopy->patient.has_value()),
    needs_lumen_(scene_.contrast.has_value()),
    isocentre_known_(scene_.fluoroscopy->isocentre.has_value())
{
}

void XRayRoom::setVessel(geometry::TriangleMesh mesh)
{
  if (!isocentre_known_ && !mesh.vertices.empty())
  {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      box.extend(vertex);
    placePatient(box.center());
  }
  if (needsCentreline())
    vessel_.mesh = mesh;
  fluoroscope_.setVessel(std::move(mesh));
  has_mesh_ = true;
  divideLumen();
}

void XRayRoom::setCentreline(vessel::CentrelineTree centreline, std::vector<vessel::PlacedLesion> lesions)
{
  vessel_.centreline = std::move(centreline);
  vessel_.lesions = std::move(lesions);
  divideLumen();
}

/** Divides the lumen for contrast medium when wall and centreline are known: the first wall, which the simulation has
 *  divided, too. */
void XRayRoom::divideLumen()
{
  if (!needs_lumen_ || !has_mesh_ || vessel_.centreline.branches.empty())
    return;
  const simulation::ContrastVessel contrast(scene_, vessel_);
  system_.setLumen(vessel_.centreline, contrast.cells, contrast.lumen);
  needs_lumen_ = false;
  if (!needs_patient_)
    vessel_ = {};
}

void XRayRoom::setState(const ImagedState& state)
{
  const fluoroscopy::BodyMotion motion = state.motion.value_or(fluoroscopy::BodyMotion());
  if (state.motion && !draws_stills_)
    system_.setHeart(motion.map().frame());
  fluoroscope_.setMotion(motion);
  if (scene_.contrast)
    system_.setContrast(state.contrast.value_or(simulation::ContrastMedium()));
  wires_.clear();
  if (!state.instruments.behind.empty())
    wires_.push_back(system_.stack(state.instruments.nodes, state.instruments.behind, motion.map()));
  std::vector<fluoroscopy::XRayWire> treatment;
  if (state.treatment)
    treatment = wiresOf(*state.treatment);
  fluoroscopy::moveWires(motion.map(), treatment);
  std::move(treatment.begin(), treatment.end(), std::back_inserter(wires_));
}

/** X-ray wires of balloons and stents in the contrast medium that is there, with the vessel at rest. */
std::vector<fluoroscopy::XRayWire> XRayRoom::wiresOf(const simulation::ImagedTreatment& treatment) const
{
  const auto middle = [](const std::vector<Eigen::Vector3d>& axis) { return axis[axis.size() / 2]; };
  std::vector<fluoroscopy::XRayWire> wires;
  for (const intervention::RoundBody& balloon : treatment.balloons)
    wires.push_back(fluoroscopy::balloonWire(balloon.axis, balloon.radii, system_.fillingAt(middle(balloon.axis))));
  for (const simulation::ImagedStent& stent : treatment.stents)
    for (fluoroscopy::XRayWire& strut : fluoroscopy::strutWires(
             intervention::stentStruts(stent.sleeve), stent.thickness, system_.metalAt(middle(stent.sleeve.axis))))
      wires.push_back(std::move(strut));
  return wires;
}

void XRayRoom::follow(const std::vector<Eigen::Vector3d>& nodes)
{
  if (nodes.empty())
    return;
  tip_ = nodes.back();
  if (!scene_.vessel && !isocentre_known_)
    placePatient(nodes[nodes.size() / 2]);
}

bool XRayRoom::canLoadPatient() const
{
  return needs_patient_ &&
         (!scene_.vessel || (!vessel_.mesh.triangles.empty() && !vessel_.centreline.branches.empty()));
}

std::vector<std::string> XRayRoom::loadPatient(const std::optional<fluoroscopy::ProgressiveResolution>& resolution)
{
  const vessel::Vessel vessel = std::exchange(vessel_, {});
  simulation::XRayPatient loaded = simulation::loadPatient(
      scene_, vessel, resolution.value_or(simulation::sequenceResolution(scene_.fluoroscopy->rate)));
  fluoroscope_.setPatient(std::move(loaded.patient));
  draws_stills_ = resolution && resolution->motion == fluoroscopy::MotionSampling::kExact;
  needs_patient_ = false;
  return loaded.notes;
}

void XRayRoom::moveTo(const fluoroscopy::CArmPose& target, bool names_isocentre)
{
  const bool places_patient = !isocentre_known_ && names_isocentre;
  fluoroscopy::Gantry commanded = gantry_;
  if (places_patient && target.isocentre.allFinite())
    commanded.placePatient(target.isocentre);
  commanded.moveTo(target);
  gantry_ = commanded;
  isocentre_known_ = isocentre_known_ || places_patient;
}

void XRayRoom::placePatient(const Eigen::Vector3d& isocentre)
{
  gantry_.placePatient(isocentre);
  applyPose();
  isocentre_known_ = true;
}

void XRayRoom::advance(double duration)
{
  if (scene_.fluoroscopy->follow_tip && tip_ && isocentre_known_)
  {
    const fluoroscopy::CArmPose& pose = gantry_.pose();
    const fluoroscopy::CArmPose panned = fluoroscopy::panToTip(pose, *tip_);
    if (panned != pose)
      gantry_.panTo(panned.isocentre);
  }
  if (gantry_.advance(duration))
    applyPose();
}

void XRayRoom::placeAt(const fluoroscopy::CArmPose& pose)
{
  if (pose == gantry_.pose())
    return;
  gantry_.stopAt(pose);
  isocentre_known_ = true;
  applyPose();
}

/** Gives the pose of the gantry to the fluoroscope. The gantry stops in front of a collision. */
void XRayRoom::applyPose()
{
  try
  {
    fluoroscope_.setPose(gantry_.pose());
  }
  catch (const InputError&)
  {
    gantry_.stopAt(fluoroscope_.geometry().pose());
    throw;
  }
}

const fluoroscopy::AngiographyFrame& XRayRoom::draw(std::uint64_t pulse, bool display)
{
  return angiography_.draw(pulse, wires_, display);
}

}  // namespace endovascular_sim::nodes
