#pragma once

namespace endovascular_sim::patient
{

/** Label of a part of the body. Parts with contrast medium are those of a CT angiogram in the arterial phase. */
enum class Tissue
{
  kAir,
  kLung,
  kFat,
  kUrine,
  kMuscle,
  kBlood,
  kCartilage,
  kBone,  ///< cortex of its usual density; each bone has its own (BodyPart)
  kVesselWall,
  kCalcium,
  // From here on with contrast medium in a CT angiogram, see hasContrast():
  kMyocardium,
  kLumen,  ///< of the arteries
  kLeftVentricle,
  kRightVentricle,
  kLeftAtrium,
  kRightAtrium,
  kPulmonaryTrunk,
  kCardiacVein,
};

/** Properties of a tissue, one per kind of image. */
struct TissueProperties
{
  float density;     ///< mass of tissue without contrast medium, which attenuates X-rays as blood or bone [kg/m³]
  float hounsfield;  ///< CT number, with the contrast medium of a CT angiogram [HU]
};

const TissueProperties& propertiesOf(Tissue tissue);

/** True for tissues whose CT number contains contrast medium, so that it does not follow from the density. */
bool hasContrast(Tissue tissue);

}  // namespace endovascular_sim::patient
