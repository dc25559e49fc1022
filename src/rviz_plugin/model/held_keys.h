#pragma once

#include <array>
#include <cstdint>

#include "rviz_plugin/model/operator_controls.h"

namespace endovascular_sim::rviz_plugin
{

/** Keys of motions, of which one that is held while another instrument is chosen acts again only after its release.
 *
 *  While a key is held, X sends pairs of a release and a press at the same time. On a busy computer, where the press is
 *  not yet in its queue, Qt takes such a pair for a release and a new press. Both have one time stamp. */
class HeldKeys
{
public:
  /** Notes a press. @param time of the event [ms]; 0: unknown
   *  @return false for a key that must be released first */
  bool press(Motion motion, std::uint64_t time);
  /** Notes a release. @param time as above */
  void release(Motion motion, std::uint64_t time);
  /** Holds back the keys that are held at present. */
  void holdBack();

private:
  struct Key
  {
    bool is_held_back = false;   ///< a repetition does not act
    std::uint64_t released = 0;  ///< time of the last release [ms]; 0: unknown
  };

  Key& keyOf(Motion motion) { return keys_[static_cast<std::size_t>(motion)]; }
  std::array<Key, kMotions> keys_;
};

}  // namespace endovascular_sim::rviz_plugin
