#include "patient/tissue/tissue.h"

#include <array>
#include <cstddef>

namespace endovascular_sim::patient
{

const TissueProperties& propertiesOf(Tissue tissue)
{
  static constexpr std::array<TissueProperties, 18> kTable = {{
      {1.2F, -1000.0F},    // air
      {260.0F, -749.0F},   // lung
      {930.0F, -98.0F},    // fat
      {1040.0F, 32.0F},    // urine
      {1050.0F, 51.0F},    // muscle
      {1060.0F, 70.0F},    // blood
      {1100.0F, 140.0F},   // cartilage
      {1450.0F, 730.0F},   // bone
      {1055.0F, 60.0F},    // wall of a vessel
      {1668.0F, 1100.0F},  // calcium
      {1060.0F, 110.0F},   // myocardium
      {1060.0F, 400.0F},   // lumen
      {1060.0F, 380.0F},   // left ventricle
      {1060.0F, 210.0F},   // right ventricle
      {1060.0F, 360.0F},   // left atrium
      {1060.0F, 200.0F},   // right atrium
      {1060.0F, 300.0F},   // pulmonary trunk
      {1060.0F, 220.0F},   // cardiac vein
  }};
  return kTable[static_cast<std::size_t>(tissue)];
}

bool hasContrast(Tissue tissue)
{
  return tissue >= Tissue::kMyocardium;
}

}  // namespace endovascular_sim::patient
