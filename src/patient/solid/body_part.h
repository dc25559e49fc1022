#pragma once

#include <vector>

#include "patient/solid/solids.h"
#include "patient/tissue/tissue.h"

namespace endovascular_sim::patient
{

/** Tissue of a part, and how the part is drawn over what is there. */
struct Material
{
  enum class Kind
  {
    kReplace,  ///< the tissue replaces what is there
    kDenser,   ///< the tissue, where it is denser than what is there
    kBone      ///< cortex of a given thickness around a trabecular core
  };
  Kind kind = Kind::kReplace;
  Tissue tissue = Tissue::kAir;
  float density = 0.0F;  ///< of the tissue, or of the cortex [kg/m³]
  float core = 0.0F;     ///< of trabecular bone [kg/m³]
  float cortex = 0.0F;   ///< thickness of the cortex [mm]
  float edge = 0.0F;     ///< width of the soft edge beyond the voxel's own width [mm]
};

inline Material replacing(Tissue tissue, float edge = 0.0F)
{
  return {Material::Kind::kReplace, tissue, propertiesOf(tissue).density, 0.0F, 0.0F, edge};
}

inline Material denser(Tissue tissue, float edge = 0.0F)
{
  return {Material::Kind::kDenser, tissue, propertiesOf(tissue).density, 0.0F, 0.0F, edge};
}

/** @param density of the cortex [kg/m³] */
inline Material bone(float density, float cortex, float core)
{
  return {Material::Kind::kBone, Tissue::kBone, density, core, cortex, 0.0F};
}

/** Union of solids of one material, minus others. */
struct BodyPart
{
  Material material;
  std::vector<SolidPointer> solids;
  std::vector<SolidPointer> holes;

  /** Approximate signed distance, as of a solid [mm]. */
  float distance(const Point& p) const;
};

/** Parts in the order in which they are drawn. */
using BodyPlan = std::vector<BodyPart>;

constexpr float kCorticalBone = 1920.0F;  ///< mass density of compact bone; bone displaces tissue in this ratio [kg/m³]

}  // namespace endovascular_sim::patient
