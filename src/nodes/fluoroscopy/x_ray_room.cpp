#include "nodes/fluoroscopy/x_ray_room.h"

#include <utility>

#include <Eigen/Geometry>

#include "common/error.h"
#include "fluoroscopy/projection/x_ray_treatment.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::nodes
{

XRayRoom::XRayRoom(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& library)
  : scene_(scene),
    system_(scene_, library),
    fluoroscope_(system_.fluoroscope()),
    gantry_(scene_.fluoroscopy->gantry, fluoroscope_.geometry().pose()),
    needs_patient_(scene_.fluoroscopy->patient.has_value()),
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
  if (needs_patient_)
    vessel_.mesh = mesh;
  fluoroscope_.setVessel(std::move(mesh));
  has_mesh_ = true;
}

void XRayRoom::setWires(std::vector<fluoroscopy::XRayWire> wires, const std::vector<Eigen::Vector3d>& nodes,
                        std::uint64_t step)
{
  wires_ = std::move(wires);
  step_ = step;
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

const fluoroscopy::Frame& XRayRoom::render(bool display)
{
  const fluoroscopy::BodyMotion& motion = motions_.at(step_);
  fluoroscope_.setMotion(motion);
  shown_ = treatment_;
  fluoroscopy::moveWires(motion.map(), shown_);
  shown_.insert(shown_.begin(), wires_.begin(), wires_.end());
  return fluoroscope_.render(shown_, display);
}

}  // namespace endovascular_sim::nodes
