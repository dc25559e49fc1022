#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "endovascular_sim/SessionGap.h"

namespace endovascular_sim::nodes
{

/** Bags of one run, in its folder: session.bag, and session_2.bag, session_3.bag, … after each interruption of the
 *  recording. */
class RunBags
{
public:
  explicit RunBags(std::string folder);

  /** Names of the bags, in their order. */
  const std::vector<std::string>& names() const { return names_; }
  /** Name of the next bag. */
  std::string nextName() const { return nameOf(names_.size() + 1); }

  /** Name of the last bag that holds a step, and the number of steps up to its last one; empty and 0 without such a
   * bag. */
  const std::string& lastName() const { return last_name_; }
  std::uint64_t steps() const { return steps_; }

  /** Completes the last bag with steps in place: restores its index, and adds a gap behind it and its end if it has
   * none.
   *  @param prefix namespace of its topics, e.g. "/"
   *  @param gap null: none
   *  @throws InputError when it cannot be written; the bag is then as before, or can be read without its index */
  void complete(const std::string& prefix, const SessionGap* gap) const;

  static std::string nameOf(std::size_t number);

private:
  void examine(const std::string& name);

  std::string folder_;
  std::vector<std::string> names_;
  std::string last_name_;
  std::string damage_;  ///< of the last bag with steps
  bool has_end_ = false;
  std::uint64_t steps_ = 0;
};

}  // namespace endovascular_sim::nodes
