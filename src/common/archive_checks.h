#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "common/archive.h"

// Checks of loaded values. A hash does not protect against states that were written by a faulty program.

namespace endovascular_sim
{

/** Throws unless a property of loaded values holds.
 *  @param otherwise completes "the saved state …"
 *  @throws ArchiveError */
inline void requireLoaded(bool holds, const char* otherwise)
{
  if (!holds)
    throw ArchiveError(otherwise);
}

inline bool isFinite(double value)
{
  return std::isfinite(value);
}

template <typename Derived>
bool isFinite(const Eigen::MatrixBase<Derived>& vector)
{
  return vector.allFinite();
}

template <typename T>
bool isFinite(const std::vector<T>& values)
{
  return std::all_of(values.begin(), values.end(), [](const T& value) { return isFinite(value); });
}

/** Throws unless all loaded numbers are finite.
 *  @throws ArchiveError */
template <typename... Values>
void requireFinite(const Values&... values)
{
  requireLoaded((isFinite(values) && ...), "holds numbers that are not finite");
}

/** Throws where a loaded number is NaN; infinity is allowed.
 *  @throws ArchiveError */
template <typename... Values>
void requireNumbers(const Values&... values)
{
  requireLoaded(!(std::isnan(values) || ...), "holds numbers that are not defined (NaN)");
}

inline void requireNumbers(const std::vector<double>& values)
{
  for (const double value : values)
    requireNumbers(value);
}

/** Throws unless begin ≤ index < end.
 *  @throws ArchiveError */
inline void requireIndex(int index, int begin, int end)
{
  requireLoaded(index >= begin && index < end, "holds an index out of its range");
}

/** Throws unless all containers have a length.
 *  @throws ArchiveError */
template <typename... Containers>
void requireLength(std::size_t length, const Containers&... containers)
{
  requireLoaded(((containers.size() == length) && ...), "holds arrays of a wrong length");
}

}  // namespace endovascular_sim
