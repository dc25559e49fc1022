#pragma once

#include <string>
#include <vector>

#include "rod/wire.h"

namespace endovascular_sim::instrument
{

/** What a section is made of, for the X-ray. */
enum class Material
{
  kNitinol,
  kSteel,
  kPlatinum,
  kPolymer,
};

/** A guidewire: its mechanics, and what X-rays see of it. */
struct Instrument
{
  std::string name;
  rod::Wire wire;
  std::vector<Material> materials;  ///< one per section of the wire
};

}  // namespace endovascular_sim::instrument
