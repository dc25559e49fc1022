#include "results/energy_audit_csv.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/output_file.h"

namespace endovascular_sim::results
{

EnergyAuditFile::EnergyAuditFile(const std::string& file) : stream_(file)
{
  if (!stream_)
    throw writeError(file);
  stream_.precision(12);
  stream_ << "time,work,stored,dissipated,numerical,error";
  for (const rod::BalanceTerm& term : rod::kBalanceTerms)
    stream_ << ',' << term.name;
  stream_ << '\n';
}

void EnergyAuditFile::add(double time, const rod::EnergyBalance& balance)
{
  stream_ << time << ',' << balance.work() << ',' << balance.stored() << ',' << balance.dissipated() << ','
          << balance.numerical() << ',' << balance.error();
  for (const rod::BalanceTerm& term : rod::kBalanceTerms)
    stream_ << ',' << balance.*term.value;
  stream_ << '\n';
}

bool EnergyAuditFile::flush()
{
  return static_cast<bool>(stream_.flush());
}

void AuditClosure::add(double time, const rod::EnergyBalance& balance)
{
  const auto second = static_cast<std::size_t>(std::max(0.0, std::ceil(time - 1e-9) - 1.0));
  // A second without a row of its own ends as the one before.
  ends_.resize(std::max(ends_.size(), second + 1), ends_.empty() ? Second() : ends_.back());
  ends_[second] = {balance.error(), balance.turnover};
}

double AuditClosure::ratio(std::size_t second) const
{
  const Second before = second > 0 ? ends_[second - 1] : Second();
  const double error = std::abs(ends_[second].error - before.error);
  const double tolerated =
      kShareOfSecond * (ends_[second].turnover - before.turnover) + kShareOfRun * ends_.back().turnover;
  return error == 0.0 ? 0.0 : error / tolerated;
}

int AuditClosure::worstSecond() const
{
  int worst = -1;
  for (std::size_t k = 0; k < ends_.size(); ++k)
    if (worst < 0 || ratio(k) > ratio(static_cast<std::size_t>(worst)))
      worst = static_cast<int>(k);
  return worst;
}

double AuditClosure::worst() const
{
  return ends_.empty() ? 0.0 : ratio(static_cast<std::size_t>(worstSecond()));
}

std::string AuditClosure::text() const
{
  char line[200];
  std::snprintf(
      line, sizeof line,
      "energy audit: closing error of the run %.3g J of %.3g J of work; largest error of a second %.2f of the "
      "tolerated one, in second %d",
      ends_.empty() ? 0.0 : ends_.back().error, ends_.empty() ? 0.0 : ends_.back().turnover, worst(),
      worstSecond() + 1);
  return line;
}

}  // namespace endovascular_sim::results
