#pragma once

#include <cstddef>

namespace endovascular_sim
{

/** Asks for an object's memory before it is needed, so that several waits pass at once. */
template <typename T>
inline void prefetch(const T& object)
{
  constexpr std::size_t kCacheLine = 64;
  const char* begin = reinterpret_cast<const char*>(&object);
  for (std::size_t at = 0; at < sizeof(T); at += kCacheLine)
    __builtin_prefetch(begin + at);
  __builtin_prefetch(begin + sizeof(T) - 1);
}

}  // namespace endovascular_sim
