#pragma once

#include <string>

#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::scene
{

/** Expected error of the hand force by the distance h of the nodes, relative to a much finer sampling
 *  (docs/PHYSICS.md, "Error of the sampling"). */
struct SamplingError
{
  double edge = 0.0;         ///< h in the narrowest bend [m]
  double mouth_edge = 0.0;   ///< h at the introducer [m]
  double free_length = 0.0;  ///< ℓ, from the introducer's mouth to the first contact; 0: no introducer [m]
  double bend_radius = 0.0;  ///< R of the bend with the largest error; 0: no centreline [m]
  double clearance = 0.0;    ///< c between wire and wall there [m]

  /** Share of a bend, h²/(20 R c) [1]. */
  double inBend() const;

  /** Share of the introducer while the wire is inserted by about ℓ, 3 h/(2 ℓ) [1]. */
  double atMouth() const;

  /** Result as a line of text. */
  std::string text() const;
};

/** Expected error of a scene with its vessel, for the wire of the first instrument. */
SamplingError expectedSamplingError(const Scene& scene, const vessel::Vessel& vessel, const EntryPose& entry);

}  // namespace endovascular_sim::scene
