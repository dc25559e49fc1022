#pragma once

#include <string>

#include "instrument/instrument.h"

namespace endovascular_sim::benchmark
{

/** Text of a straight specimen as the value of a scene's key `instrument`: a length of shaft with the section at a
 *  distance from the tip, without rest curvature, markers and balloon.
 *  @param name of the instrument in the scene
 *  @param from_tip of the section [m]
 *  @param length of the specimen [m] */
std::string shaftSpecimen(const instrument::Instrument& instrument, const std::string& name, double from_tip,
                          double length);

/** Text of the straightened distal part of an instrument with its sections, lengthened at the proximal end if the
 *  instrument is shorter. @param length of the part [m] */
std::string tipSpecimen(const instrument::Instrument& instrument, const std::string& name, double length);

/** Section at a distance from the tip [m]; the first one beyond the proximal end. */
const rod::Section& sectionFromTip(const rod::Wire& wire, double from_tip);

/** Distance from the tip to the middle of the longest section [m]. */
double middleOfShaft(const rod::Wire& wire);

}  // namespace endovascular_sim::benchmark
