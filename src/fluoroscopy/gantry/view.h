#pragma once

#include <optional>
#include <string>

namespace endovascular_sim::fluoroscopy
{

/** Angulation of a C-arm. */
struct View
{
  double primary_angle = 0.0;    ///< LAO positive [rad]
  double secondary_angle = 0.0;  ///< cranial positive [rad]
};

/** Angulation of a view in clinical notation.
 *
 *  Named views are AP, lateral (LAO 90) and spider (LAO 45 CAU 30; the literature gives LAO 40–50, caudal 25–40).
 *  Any other view names its angles in degrees: `LAO n` or `RAO n`, `CRA n` or `CAU n`, or one of each, for example
 *  `RAO 30 CAU 20` or `AP CRA 30`. Case and spaces do not matter.
 *  @return nothing for another text */
std::optional<View> parseView(const std::string& text);

/** Error for an unknown view, with the list of known ones. */
std::string unknownView(const std::string& text);

}  // namespace endovascular_sim::fluoroscopy
