#include "drive/arbiter.h"

#include <limits>

#include "drive/joint_command.h"

namespace endovascular_sim::drive
{

void Arbiter::advance(double dt)
{
  driver_silence_ += dt;
  silence_ += dt;
}

bool Arbiter::isDrivenByAnother(const std::string& client, bool is_busy) const
{
  const bool is_present = is_busy || (driver_silence_ >= 0.0 && driver_silence_ < time_out_);
  return !driver_.empty() && driver_ != client && is_present;
}

bool Arbiter::permits(const std::string& client, const std::string& word, bool is_busy)
{
  const bool is_free = word == "enable" || word == "disable" || word == "pause";
  if (!isStateCommand(word))
    reject(CommandVerdict::kMalformed, "state_command", client,
           std::string("unknown word; known are ") + kStateCommands);
  else if (!is_free && isDrivenByAnother(client, is_busy))
    reject(CommandVerdict::kForeign, word, client, foreignReason());
  else
    return true;
  return false;
}

void Arbiter::accept(const std::string& client)
{
  ++accepted_;
  silence_ = 0.0;
  take(client);
}

void Arbiter::take(const std::string& client)
{
  driver_ = client;
  driver_silence_ = 0.0;
}

const std::string& Arbiter::reject(CommandVerdict verdict, const std::string& command, const std::string& client,
                                   const std::string& reason)
{
  rejected_.add(verdict);
  if (verdict != CommandVerdict::kForeign && client == driver_)
    keepDriver();
  last_refusal_ = command + " of " + client + ": " + reason;
  return last_refusal_;
}

void Arbiter::copyRejections(const Arbiter& other)
{
  const std::uint64_t clamped = rejected_.clamped;  // commands that were taken over
  rejected_ = other.rejected_;
  rejected_.clamped = clamped;
  last_refusal_ = other.last_refusal_;
}

double Arbiter::silence() const
{
  return accepted_ > 0 ? silence_ : std::numeric_limits<double>::infinity();
}

}  // namespace endovascular_sim::drive
