#pragma once

#include <optional>
#include <string>

#include "common/quantity.h"

namespace endovascular_sim
{

/** Value of a unit that a user has written after a number, in the unit of the quantity: "mm" is 0.001 for a length.
 *  Spellings without ², ³, µ and · are the same unit: "N.mm2", "Nmm^2" and "N·mm²".
 *  @return empty for text that is no unit of the quantity. French is a unit of diameters, not of radii. */
std::optional<double> unitValue(const Quantity& quantity, const std::string& unit);

/** Remedy for text that is no unit of the quantity: the dimension of the written unit, if there is one of this name,
 *  and the units of the quantity. */
std::string unitRemedy(const Quantity& quantity, const std::string& unit);

}  // namespace endovascular_sim
