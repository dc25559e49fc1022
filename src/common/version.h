#pragma once

namespace endovascular_sim
{

/** Version number of the package, e.g. "0.1.0". */
const char* version();

/** Commit that the library was built from, 12 hexadecimal digits, with "-dirty" for uncommitted changes; "unknown"
 *  outside a git checkout. */
const char* commit();

/** Number of the physics: simulations with equal numbers and equal inputs give equal trajectories, bit for bit. Every
 *  change of results increments it. Recordings hold it, and `replay` requires it. */
constexpr int kPhysicsNumber = 8;

}  // namespace endovascular_sim
