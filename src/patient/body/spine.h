#pragma once

#include <string>
#include <vector>

#include "patient/solid/solids.h"

namespace endovascular_sim::patient
{

/** Dimensions of a vertebra [mm]. */
struct Vertebra
{
  std::string name;
  float height = 0.0F;          ///< posterior height of the body
  float width = 0.0F;           ///< width of the upper endplate
  float depth = 0.0F;           ///< depth of the upper endplate
  float pedicle_width = 0.0F;   ///< of the oval section
  float pedicle_height = 0.0F;  ///< of the oval section
  float disc = 0.0F;            ///< height of the disc above
  float centre = 0.0F;          ///< z of the body's centre
};

/** Vertebrae from L5 to C6, with centres from their heights and discs; the body of L4 is centred at z = 0. */
const std::vector<Vertebra>& vertebrae();

/** Level of a vertebra by name, e.g. "T5". */
const Vertebra& vertebra(const std::string& name);

/** Line through the centres of the vertebral bodies in the median plane. The shape is that of a usual spine, moved
 * backwards where a vessel needs the space. */
class SpineCurve
{
public:
  /** @param vessel points of the wall of the vessel, in the body's frame */
  explicit SpineCurve(const std::vector<Point>& vessel);

  /** Position y of the line at a height z. */
  float y(float z) const { return curve_.at(z); }

  /** Slope dy/dz. */
  float slope(float z) const { return 0.1F * (y(z + 5.0F) - y(z - 5.0F)); }

  /** Largest displacement for the vessel. */
  float displacement() const { return displacement_; }

private:
  Profile curve_;
  float displacement_ = 0.0F;
};

}  // namespace endovascular_sim::patient
