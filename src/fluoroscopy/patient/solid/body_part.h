#pragma once

#include <vector>

#include "fluoroscopy/patient/solid/solids.h"

namespace endovascular_sim::fluoroscopy::body
{

/** What a part puts into the voxels of its solids. */
struct Material
{
  enum class Kind
  {
    kReplace,  ///< tissue of this density replaces what is there
    kDenser,   ///< tissue of this density where it is denser than what is there
    kBone      ///< cortex of a given thickness around a trabecular core
  };
  Kind kind = Kind::kReplace;
  float density = 0.0F;  ///< of tissue, or of the cortex [kg/m³]
  float core = 0.0F;     ///< of trabecular bone [kg/m³]
  float cortex = 0.0F;   ///< thickness of the cortex [mm]
  float edge = 0.0F;     ///< width of the soft edge beyond the voxel's own width [mm]
};

inline Material tissue(float density, float edge = 0.0F)
{
  return {Material::Kind::kReplace, density, 0.0F, 0.0F, edge};
}

inline Material denser(float density, float edge = 0.0F)
{
  return {Material::Kind::kDenser, density, 0.0F, 0.0F, edge};
}

inline Material bone(float density, float cortex, float core)
{
  return {Material::Kind::kBone, density, core, cortex, 0.0F};
}

/** Union of solids of one material, minus others. */
struct BodyPart
{
  Material material;
  std::vector<SolidPointer> solids;
  std::vector<SolidPointer> holes;
};

/** Parts in the order in which they are drawn. */
using BodyPlan = std::vector<BodyPart>;

constexpr float kMuscle = 1050.0F;        ///< [kg/m³]
constexpr float kFat = 930.0F;            ///< [kg/m³]
constexpr float kBlood = 1060.0F;         ///< [kg/m³]
constexpr float kLung = 260.0F;           ///< [kg/m³]
constexpr float kCartilage = 1100.0F;     ///< [kg/m³]
constexpr float kCorticalBone = 1920.0F;  ///< mass density of compact bone; bone displaces tissue in this ratio [kg/m³]

}  // namespace endovascular_sim::fluoroscopy::body
