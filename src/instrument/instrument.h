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
  kBalloonCatheter,  ///< with or without a stent
  kStent,            ///< stent without a delivery system
};

/** Material of a section; determines the X-ray attenuation. */
enum class Material
{
  kNitinol,
  kSteel,
  kPlatinum,
  kPolymer,
  kFilledPolymer,  ///< polymer filled with barium sulfate
};

/** Name of a material in instrument files. */
const char* materialName(Material material);

/** Radiopaque marker band on a shaft. */
struct Marker
{
  double from_tip = 0.0;  ///< distance from the tip to the band's distal edge [m]
  double length = 0.0;    ///< [m]
  Material material = Material::kPlatinum;
};

/** Measurement of the pressure at an opening of the instrument, through its lumen or by a sensor on it. */
struct PressureLine
{
  double from_tip = 0.0;            ///< distance of the opening from the tip [m]
  double natural_frequency = 15.0;  ///< [Hz]
  double damping = 0.3;             ///< damping ratio [1]
};

/** Holes in the side of a shaft, through which contrast medium leaves beside the end hole. */
struct SideHoles
{
  double from_tip = 0.0;  ///< distance of the first one from the tip [m]
  double spacing = 0.0;   ///< distance between two of them [m]
  int count = 0;
};

/** Interventional device: mechanics of the shaft, radiopacity, balloon and stent. */
struct Instrument
{
  std::string name;
  Kind kind = Kind::kGuidewire;
  rod::Wire wire;                   ///< shaft; without sections for a bare stent
  std::vector<Material> materials;  ///< one per section of the wire
  double inner_radius = 0.0;        ///< radius of the shaft's lumen, constant over its length; 0 without a lumen [m]
  std::vector<Marker> markers;      ///< in any order
  std::optional<Balloon> balloon;   ///< set for a balloon catheter
  std::optional<PressureLine> pressure_line;  ///< empty: the usual one for a shaft with a lumen, else none
  std::optional<SideHoles> side_holes;        ///< empty: the end hole alone
  std::optional<Stent> stent;                 ///< crimped on the centre of the balloon, or the bare stent
};

/** Pressure line of an instrument: its own one, or the usual one of a catheter; none for a wire without a sensor. */
std::optional<PressureLine> pressureLineOf(const Instrument& instrument);

/** Distances from the tip at which contrast medium leaves an instrument: its end hole and its side holes [m]. */
std::vector<double> openingsOf(const Instrument& instrument);

/** Crossing profile as a radius [m]: the largest of the sections, the folded balloon and the crimped stent. */
double crossingRadius(const Instrument& instrument);

/** True if @p inner passes through the whole lumen of @p outer. */
bool fitsInside(const Instrument& inner, const Instrument& outer);

}  // namespace endovascular_sim::instrument
