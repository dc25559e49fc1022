#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contrast/cells/cell_finder.h"
#include "contrast/lumen/lumen_cells.h"
#include "fluoroscopy/beam/material_library.h"
#include "fluoroscopy/fluoroscope.h"
#include "fluoroscopy/projection/x_ray_instrument.h"
#include "motion/map/motion_map.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** Motion of a simulation's patient after the last step; at rest in a scene without motion. */
fluoroscopy::BodyMotion bodyMotion(const Simulation& simulation);

/** Contrast medium in vessel and instruments [mgI/ml]. */
struct ContrastMedium
{
  std::vector<double> cells;        ///< one per cell of the lumen
  std::vector<double> instruments;  ///< in the lumen of each instrument; empty: none in any
};

/** Contrast medium of a simulation, for FluoroscopySystem::setContrast(); empty where there is none. */
ContrastMedium contrastMedium(const Simulation& simulation);

/** X-ray system of a scene, and the X-ray wires of instruments, balloons and stents. */
class FluoroscopySystem
{
public:
  /** @param scene must outlive this
   *  @throws InputError for a scene without fluoroscopy, or with a material that the library does not contain */
  FluoroscopySystem(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& library);

  fluoroscopy::Fluoroscope& fluoroscope() { return fluoroscope_; }
  const std::vector<fluoroscopy::XRayInstrument>& instruments() const { return instruments_; }
  /** Fluids around the instruments: contrast medium in a vessel, else tissue, else air. */
  const fluoroscopy::LocalFluids& fluids() const { return fluids_; }
  /** Density of a balloon's filling minus that of its surroundings. */
  const fluoroscopy::DeviceDensity& filling() const { return filling_; }
  /** Density of a stent's struts minus that of their surroundings. */
  const fluoroscopy::DeviceDensity& metal() const { return metal_; }

  /** Density of a balloon's filling minus that of the contrast medium at a place of the resting vessel [m]. */
  fluoroscopy::DeviceDensity fillingAt(const Eigen::Vector3d& place) const;
  /** Density of a stent's struts minus that of the contrast medium at a place of the resting vessel [m]. */
  fluoroscopy::DeviceDensity metalAt(const Eigen::Vector3d& place) const;

  /** Sets the parts of the lumen of the fluoroscope's vessel.
   *  @throws InputError for those of another vessel */
  void setLumen(const vessel::CentrelineTree& centreline, const contrast::ContrastCells& cells,
                std::shared_ptr<const contrast::LumenCells> lumen);

  bool hasLumen() const { return lumen_ != nullptr; }  ///< setLumen() has been called

  /** Sets the contrast medium in vessel and instruments, in place of an even one.
   *  @throws InputError if a number is missing or negative; nothing changes */
  void setContrast(const ContrastMedium& medium);

  /** X-ray wire of the instruments on their centreline, in the contrast medium that is there.
   *  @param nodes from proximal to distal, in the moved patient [m]
   *  @param behind per instrument: arc length from its tip to the last node [m]
   *  @param map of the patient's motion */
  fluoroscopy::XRayWire stack(const std::vector<Eigen::Vector3d>& nodes, const std::vector<double>& behind,
                              const motion::MotionMap& map) const;

  /** Draws the moving tissue of sequences at the phases of a PhaseGrid. Without effect in a scene without motion.
   *  @param heart of the patient */
  void setHeart(const motion::HeartFrame& heart);

  /** X-ray wires of all instruments, balloons and stents of a simulation, where they are in the moved patient. */
  std::vector<fluoroscopy::XRayWire> wires(const Simulation& simulation) const;

private:
  fluoroscopy::DeviceDensity bloodAt(const Eigen::Vector3d& place) const;

  const scene::Scene& scene_;
  fluoroscopy::Fluoroscope fluoroscope_;
  std::vector<fluoroscopy::XRayInstrument> instruments_;
  fluoroscopy::LocalFluids fluids_;
  fluoroscopy::DeviceDensity filling_, metal_;
  std::optional<contrast::CellFinder> finder_;
  std::shared_ptr<const contrast::LumenCells> lumen_;
  std::vector<double> parts_;                       ///< concentrations of the lumen's parts; empty: even [mgI/ml]
  std::vector<fluoroscopy::DeviceDensity> lumens_;  ///< in the instruments; empty: those of fluids_
  std::optional<motion::HeartFrame> heart_;         ///< of the phases of the fluoroscope
};

}  // namespace endovascular_sim::simulation
