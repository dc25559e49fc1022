#pragma once

#include <optional>
#include <string>
#include <vector>

#include "instrument/balloon.h"
#include "instrument/stent.h"
#include "rod/model/wire.h"

namespace endovascular_sim::instrument
{

enum class Kind
{
  kGuidewire,
  kCatheter,
  kBalloonCatheter,  ///< may carry a stent
  kStent,            ///< by itself: it has no shaft
};

/** What a section is made of, for the X-ray. */
enum class Material
{
  kNitinol,
  kSteel,
  kPlatinum,
  kPolymer,
  kFilledPolymer,  ///< with barium sulfate
};

/** As files write it. */
const char* materialName(Material material);

/** A radiopaque ring on a shaft. */
struct Marker
{
  double from_tip = 0.0;  ///< from the tip to the ring's distal edge [m]
  double length = 0.0;    ///< [m]
  Material material = Material::kPlatinum;
};

/** A device: the mechanics of its shaft, what X-rays see of it, and what it carries. */
struct Instrument
{
  std::string name;
  Kind kind = Kind::kGuidewire;
  rod::Wire wire;                   ///< the shaft; no section for a stent by itself
  std::vector<Material> materials;  ///< one per section of the wire
  double inner_radius = 0.0;        ///< of the lumen over the whole length; 0: none [m]
  std::vector<Marker> markers;      ///< from the tip backwards or in any order
  std::optional<Balloon> balloon;   ///< of a balloon catheter
  std::optional<Stent> stent;       ///< on the balloon, centred; or the stent by itself
};

/** Radius of the hole that the whole instrument passes: of the thickest section, the folded balloon or the crimped
 *  stent [m]. */
double crossingRadius(const Instrument& instrument);

/** Whether @p inner can be pushed through the whole lumen of @p outer. */
bool fitsInside(const Instrument& inner, const Instrument& outer);

}  // namespace endovascular_sim::instrument
