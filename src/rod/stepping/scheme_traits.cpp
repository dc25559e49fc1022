#include "rod/stepping/scheme_traits.h"

#include <stdexcept>

namespace endovascular_sim::rod
{

const std::vector<SchemeTraits>& schemes()
{
  // clang-format off
  static const std::vector<SchemeTraits> table = {
      //        balloons stack  moves  holds  torque adaptive saves  observes streams moving_walls
      {"kkt",   true,    true,  true,  true,  true,  true,    true,  true,    true,   true},
      {"paper", false,   false, false, false, true,  true,    false, false,   false,  false},
      {"mixed", false,   false, false, false, false, false,   false, false,   false,  false},
  };
  // clang-format on
  return table;
}

const SchemeTraits& schemeTraits(const std::string& name)
{
  for (const SchemeTraits& traits : schemes())
    if (traits.name == name)
      return traits;
  throw std::invalid_argument("unknown scheme '" + name + "'");
}

}  // namespace endovascular_sim::rod
