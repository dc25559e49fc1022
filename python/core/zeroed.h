#pragma once

#include <cstddef>
#include <cstring>
#include <new>

namespace endovascular_sim::python
{

/** Base of bound classes: their memory begins as zeros. pybind11 passes memory without an object to the methods of
 *  an object that Python made with `__new__` alone; zeros are null pointers, which methods refuse. */
struct Zeroed
{
  static void* operator new(std::size_t size) { return std::memset(::operator new(size), 0, size); }
  static void* operator new(std::size_t, void* place) { return place; }
  static void operator delete(void* memory) { ::operator delete(memory); }
};

}  // namespace endovascular_sim::python
