#include "rviz_plugin/model/held_keys.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr std::uint64_t kRepetition = 10;  // longest time between release and press of a key that is held [ms]

}  // namespace

bool HeldKeys::press(Motion motion, std::uint64_t time)
{
  Key& key = keyOf(motion);
  const bool is_repetition = key.released > 0 && time >= key.released && time - key.released <= kRepetition;
  key.is_held_back = key.is_held_back && is_repetition;
  return !key.is_held_back;
}

void HeldKeys::release(Motion motion, std::uint64_t time)
{
  keyOf(motion).released = time;
}

void HeldKeys::holdBack()
{
  for (Key& key : keys_)
    key.is_held_back = true;  // a press of one that is not held is no repetition, and acts
}

}  // namespace endovascular_sim::rviz_plugin
