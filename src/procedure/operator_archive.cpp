#include "procedure/operator.h"

// Serialization of the scripted operator.

namespace endovascular_sim::procedure
{

namespace
{

constexpr std::uint64_t kMaxRecords = 1000000;

}  // namespace

/** Archives the records. Their names are derived from the steps. */
void Operator::archiveRecords(Archive& archive)
{
  std::uint64_t count = records_.size();
  archive(count);
  if (archive.reading() && count > kMaxRecords)
    throw ArchiveError("has an implausible number of steps");
  records_.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < records_.size(); ++k)
  {
    StepRecord& record = records_[k];
    std::uint64_t step = record.step;
    archive(step, record.begin, record.end, record.retries, record.wrong_branches, record.outcome);
    if (archive.reading() && step >= steps_.size())
      throw ArchiveError("refers to a step that the procedure does not have");
    record.step = static_cast<std::size_t>(step);
    record.name = nameOf(steps_[record.step]);
    record.hint = steps_[record.step].hint;
    record.view = viewOf(record.step);
    record.phase = steps_[record.step].phase.empty() && k > 0 ? records_[k - 1].phase : steps_[record.step].phase;
  }
}

void Operator::archive(Archive& archive)
{
  std::uint64_t current = current_;
  archive(current, begun_, progress_, mode_, begin_time_, begin_insertion_, begin_rotation_, reached_since_,
          lost_since_, progress_time_, progress_insertion_, progress_tip_, mode_insertion_, mode_rotation_, mode_time_);
  for (Hand& hand : hands_)
    archive(hand);
  archiveRecords(archive);
  archive(entries_);
  if (!archive.reading())
    return;
  if (current > steps_.size() || (current == steps_.size() && progress_ == Progress::kRunning))
    throw ArchiveError("refers to a step that the procedure does not have");
  current_ = static_cast<std::size_t>(current);
  if (begun_ && current_ < steps_.size())
    prepareStep();
  if (progress_ == Progress::kFailed)
    failure_ =
        "step " + std::to_string(records_.size()) + " (" + records_.back().name + ") failed before the state was saved";
}

}  // namespace endovascular_sim::procedure
