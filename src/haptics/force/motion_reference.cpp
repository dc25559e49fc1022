#include "haptics/force/motion_reference.h"

#include <algorithm>

namespace endovascular_sim::haptics
{

std::optional<HandMotion> MotionReference::update(const HandMotion& count)
{
  if (!isFinite(count))
  {
    ++rejected_;
    return std::nullopt;
  }
  if (!anchored_)
  {
    anchor(count);
    return command_;
  }
  if (isJump(last_, count))
  {
    // A single outlier is a corrupt sample that passed the 8-bit checksum. A second, consistent one indicates a device
    // restart.
    if (!suspect_ || isJump(*suspect_, count))
    {
      suspect_ = count;
      ++rejected_;
      return std::nullopt;
    }
    anchor(count);
    return command_;
  }
  suspect_.reset();
  last_ = count;
  command_.insertion = base_.insertion + (count.insertion - reference_.insertion);
  command_.rotation = base_.rotation + (count.rotation - reference_.rotation);
  return command_;
}

void MotionReference::anchor(const HandMotion& count)
{
  if (started_)
    ++rebased_;
  started_ = anchored_ = true;
  base_ = command_;
  reference_ = last_ = count;
  suspect_.reset();
}

void SampleTimes::add(const HandMotion& command, std::uint32_t time)
{
  entries_[count_ % entries_.size()] = {command, time};
  ++count_;
}

std::optional<std::uint32_t> SampleTimes::find(const HandMotion& command) const
{
  const std::size_t known = std::min(count_, entries_.size());
  for (std::size_t back = 1; back <= known; ++back)
  {
    const Entry& entry = entries_[(count_ - back) % entries_.size()];
    if (entry.command.insertion == command.insertion && entry.command.rotation == command.rotation)
      return entry.time;
  }
  return std::nullopt;
}

}  // namespace endovascular_sim::haptics
