#pragma once

#include <vector>

#include "fluoroscopy/beam/material_library.h"
#include "fluoroscopy/fluoroscope.h"
#include "fluoroscopy/projection/x_ray_instrument.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** X-ray system of a scene, and the X-ray wires of instruments, balloons and stents. */
class FluoroscopySystem
{
public:
  /** @param scene must outlive this
   *  @throws InputError for a scene without fluoroscopy, or with a material that the table does not know */
  FluoroscopySystem(const scene::Scene& scene, const fluoroscopy::MaterialLibrary& table);

  fluoroscopy::Fluoroscope& fluoroscope() { return fluoroscope_; }
  const std::vector<fluoroscopy::XRayInstrument>& instruments() const { return instruments_; }
  double filling() const
  {
    return filling_;
  }                                        ///< attenuation of a balloon's filling less that of its surroundings [1/m]
  double metal() const { return metal_; }  ///< attenuation of a stent's struts less that of its surroundings [1/m]

  /** X-ray wires of all instruments, balloons and stents of a simulation. */
  std::vector<fluoroscopy::XRayWire> wires(const Simulation& simulation) const;

private:
  fluoroscopy::Fluoroscope fluoroscope_;
  std::vector<fluoroscopy::XRayInstrument> instruments_;
  double filling_ = 0.0;
  double metal_ = 0.0;
};

}  // namespace endovascular_sim::simulation
