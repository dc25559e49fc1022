#pragma once

#include <cstdint>

#include "patient/solid/solids.h"

namespace endovascular_sim::patient
{

/** Value noise in [−1, 1] with trilinear interpolation of random values on a cubic lattice. A function of position and
 * seed.
 *  @param cell lattice constant [mm] */
float valueNoise(const Point& p, float cell, std::uint64_t seed);

/** Relative density of trabecular bone: mean 1, structures of 1.6 and 4 mm. */
float trabecularTexture(const Point& p, std::uint64_t seed);

/** Relative density of soft tissue: mean 1, structures of 9 mm and 2 % amplitude. */
float softTexture(const Point& p, std::uint64_t seed);

}  // namespace endovascular_sim::patient
