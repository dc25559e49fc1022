#include "robot/command_faults.h"

#include <algorithm>
#include <utility>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::robot
{
namespace
{

double& on(FaultAxis axis, drive::HandCommand& command)
{
  return axis == FaultAxis::kInsertion ? command.insertion : command.rotation;
}

bool isOn(const CommandFault& fault, std::size_t instrument, FaultAxis axis)
{
  return fault.settings().instrument == instrument && fault.settings().axis == axis;
}

}  // namespace

CommandFaults::CommandFaults(const std::vector<FaultSettings>& faults, std::vector<drive::HandCommand> start,
                             double time_step, std::uint64_t seed)
  : time_step_(time_step), seed_(seed), offsets_(start.size()), lags_(start.size()), executed_(std::move(start))
{
  for (const FaultSettings& fault : faults)
    add(fault);
}

std::vector<FaultSettings> CommandFaults::settings() const
{
  std::vector<FaultSettings> settings;
  for (const CommandFault& fault : faults_)
    settings.push_back(fault.settings());
  return settings;
}

void CommandFaults::add(const FaultSettings& fault)
{
  faults_.emplace_back(fault, time_step_, seed_, on(fault.axis, executed_[fault.instrument]));
}

double& CommandFaults::offset(std::size_t instrument, FaultAxis axis)
{
  return axis == FaultAxis::kInsertion ? offsets_[instrument].insertion : offsets_[instrument].rotation;
}

std::size_t CommandFaults::remove(std::size_t instrument, FaultAxis axis)
{
  const std::size_t before = faults_.size();
  for (const CommandFault& fault : faults_)
    if (isOn(fault, instrument, axis) && fault.slipped() != 0.0)
    {
      offset(instrument, axis) += fault.slipped();
      keeps_offsets_ = true;
    }
  faults_.erase(std::remove_if(faults_.begin(), faults_.end(),
                               [&](const CommandFault& fault) { return isOn(fault, instrument, axis); }),
                faults_.end());
  if (empty())
    lags_.assign(lags_.size(), {});
  return before - faults_.size();
}

void CommandFaults::setSeed(std::uint64_t seed)
{
  seed_ = seed;
  for (CommandFault& fault : faults_)
    fault.setSeed(seed);
}

const std::vector<drive::HandCommand>& CommandFaults::execute(std::uint64_t step,
                                                              const std::vector<drive::HandCommand>& commands)
{
  executed_ = commands;
  if (empty())
    return commands;
  for (std::size_t k = 0; k < executed_.size(); ++k)
  {
    executed_[k].insertion -= offsets_[k].insertion;
    executed_[k].rotation -= offsets_[k].rotation;
  }
  for (CommandFault& fault : faults_)
  {
    double& position = on(fault.settings().axis, executed_[fault.settings().instrument]);
    position = fault.execute(step, position);
  }
  for (std::size_t k = 0; k < executed_.size(); ++k)
    lags_[k] = {commands[k].insertion - executed_[k].insertion, commands[k].rotation - executed_[k].rotation};
  return executed_;
}

void CommandFaults::restAt(const std::vector<drive::HandCommand>& commands)
{
  executed_ = commands;
  offsets_.assign(offsets_.size(), {});
  lags_.assign(lags_.size(), {});
  keeps_offsets_ = false;
  for (CommandFault& fault : faults_)
    fault.restAt(on(fault.settings().axis, executed_[fault.settings().instrument]));
}

void CommandFaults::archive(Archive& archive)
{
  archive(seed_, faults_, keeps_offsets_);
  for (std::size_t k = 0; k < executed_.size(); ++k)
  {
    archive(offsets_[k].insertion, offsets_[k].rotation, lags_[k].insertion, lags_[k].rotation, executed_[k].insertion,
            executed_[k].rotation, executed_[k].pressure);
    if (archive.reading())
      requireFinite(offsets_[k].insertion, offsets_[k].rotation, lags_[k].insertion, lags_[k].rotation,
                    executed_[k].insertion, executed_[k].rotation, executed_[k].pressure);
  }
  for (const CommandFault& fault : faults_)
    requireLoaded(fault.settings().instrument < executed_.size(), "holds a fault of an unknown instrument");
}

}  // namespace endovascular_sim::robot
