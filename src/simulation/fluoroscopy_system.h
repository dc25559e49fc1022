#pragma once

#include <vector>

#include "fluoroscopy/beam/material_library.h"
#include "fluoroscopy/fluoroscope.h"
#include "fluoroscopy/projection/x_ray_instrument.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** Motion of a simulation's patient after the last step; at rest in a scene without motion. */
fluoroscopy::BodyMotion bodyMotion(const Simulation& simulation);

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

  /** X-ray wires of all instruments, balloons and stents of a simulation, where they are in the moved patient. */
  std::vector<fluoroscopy::XRayWire> wires(const Simulation& simulation) const;

private:
  fluoroscopy::Fluoroscope fluoroscope_;
  std::vector<fluoroscopy::XRayInstrument> instruments_;
  fluoroscopy::LocalFluids fluids_;
  fluoroscopy::DeviceDensity filling_, metal_;
};

}  // namespace endovascular_sim::simulation
