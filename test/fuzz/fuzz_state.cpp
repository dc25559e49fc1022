#include <cstdint>
#include <sstream>
#include <string>

#include "common/error.h"
#include "common/hash.h"
#include "test/fuzz/fuzz_simulation.h"

// Saved states. The first byte of an input selects whether its hash is renewed: without it, hardly an input would pass
// the check of the hash.

using namespace endovascular_sim;  // NOLINT: a program's main file

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  if (size == 0)
    return 0;
  std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  std::uint64_t hash = 0;
  if (data[0] % 2U == 0 && bytes.size() >= sizeof hash)
  {
    bytes.resize(bytes.size() - sizeof hash);
    Hash64 renewed;
    renewed.add(bytes.data(), bytes.size());
    hash = renewed.value();
    bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  }
  fuzz::SmallSimulation small;
  try
  {
    std::istringstream stream(bytes);
    small.simulation.load(stream, 0, "state");
  }
  catch (const InputError&)
  {
    return 0;
  }
  return 0;
}
