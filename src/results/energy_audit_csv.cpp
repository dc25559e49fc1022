#include "results/energy_audit_csv.h"

#include <algorithm>
#include <cmath>

#include "common/output_file.h"
#include "common/text/format.h"

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
  if (ends_.empty())
    first_second_ = second;
  // A second without a row of its own ends as the one before.
  ends_.resize(std::max(ends_.size(), second - first_second_ + 1), ends_.empty() ? Amount() : ends_.back());
  ends_.back() = {balance.error(), balance.turnover};
}

AuditClosure::Amount AuditClosure::inSecond(std::size_t k) const
{
  const Amount before = k > 0 ? ends_[k - 1] : Amount();
  return {std::abs(ends_[k].error - before.error), ends_[k].turnover - before.turnover};
}

double AuditClosure::ratio(std::size_t k) const
{
  const Amount amount = inSecond(k);
  const double mean = ends_.back().turnover / static_cast<double>(ends_.size());
  return amount.error == 0.0 ? 0.0 : amount.error / (kShareOfSecond * amount.turnover + kShareOfRun * mean);
}

std::size_t AuditClosure::worstIndex() const
{
  std::size_t worst = 0;
  for (std::size_t k = 1; k < ends_.size(); ++k)
    if (ratio(k) > ratio(worst))
      worst = k;
  return worst;
}

int AuditClosure::worstSecond() const
{
  return ends_.empty() ? -1 : static_cast<int>(first_second_ + worstIndex());
}

double AuditClosure::worst() const
{
  return ends_.empty() ? 0.0 : ratio(worstIndex());
}

double AuditClosure::shareOfRun() const
{
  double error = 0.0;
  for (std::size_t k = 0; k < ends_.size(); ++k)
    error += inSecond(k).error;
  return error == 0.0 ? 0.0 : error / ends_.back().turnover;
}

std::string AuditClosure::text() const
{
  if (ends_.empty())
    return "energy audit: no step";
  const Amount amount = inSecond(worstIndex());
  return formatted(
      "energy audit: %s; largest unexplained share %.2g %% of the turnover of second %d, %.2f of the tolerated "
      "(%.3g J of %.3g J); in sum %.2g %% of the run's %.3g J, tolerated %.0f %%",
      accepted() ? "within" : "beyond", amount.error == 0.0 ? 0.0 : 100.0 * amount.error / amount.turnover,
      worstSecond() + 1, worst(), amount.error, amount.turnover, 100.0 * shareOfRun(), ends_.back().turnover,
      100.0 * kShareOfRun);
}

}  // namespace endovascular_sim::results
