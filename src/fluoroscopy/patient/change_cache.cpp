#include "fluoroscopy/patient/change_cache.h"

namespace endovascular_sim::fluoroscopy
{

const std::vector<float>* ChangeCache::find(const BodyMotion& motion) const
{
  for (const auto& [known, change] : entries_)
    if (known == motion)
      return &change;
  return nullptr;
}

void ChangeCache::put(const BodyMotion& motion, std::vector<float> change)
{
  const std::size_t size = change.size() * sizeof(float);
  if (size > memory_)
    return;
  while ((entries_.size() + 1) * size > memory_)
    entries_.pop_front();
  entries_.emplace_back(motion, std::move(change));
}

}  // namespace endovascular_sim::fluoroscopy
