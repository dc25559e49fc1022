#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "rod/energy/energy_balance.h"

namespace endovascular_sim::results
{

/** Writer of energy_audit.csv: the terms of the balance, their sums and the closing error, cumulative [J]. */
class EnergyAuditFile
{
public:
  /** @throws InputError if the file cannot be written */
  explicit EnergyAuditFile(const std::string& file);

  /** Adds a row. @param time simulated time [s] */
  void add(double time, const rod::EnergyBalance& balance);

  /** Flushes the file to the operating system. @return false on failure */
  bool flush();

private:
  std::ofstream stream_;
};

/** Part of the work that no term of an audit explains, in each second of the simulated time and in the run. */
class AuditClosure
{
public:
  static constexpr double kShareOfSecond = 0.02;  ///< tolerated in a second: share of the second's turnover …
  static constexpr double kShareOfRun = 0.01;  ///< … plus this share of the mean turnover of all seconds; and in sum

  /** Notes a balance. @param time simulated time [s], ascending */
  void add(double time, const rod::EnergyBalance& balance);

  /** Largest unexplained part of a second relative to the tolerated one, by magnitudes [1]. */
  double worst() const;

  /** Second with the largest part relative to the tolerated one, counted from time 0; −1 without a row. */
  int worstSecond() const;

  /** Sum of the magnitudes of the unexplained parts of all seconds over the turnover of the run [1]. */
  double shareOfRun() const;

  /** True if every second and the sum are within the tolerated. */
  bool accepted() const { return worst() <= 1.0 && shareOfRun() <= kShareOfRun; }

  /** Result as a line of text: the largest unexplained share, the sum, and the acceptance. */
  std::string text() const;

private:
  /** Unexplained part and turnover since the start, or of one second [J]. */
  struct Amount
  {
    double error = 0.0;
    double turnover = 0.0;
  };

  Amount inSecond(std::size_t k) const;
  double ratio(std::size_t k) const;
  std::size_t worstIndex() const;

  std::size_t first_second_ = 0;  ///< second of the first row
  std::vector<Amount> ends_;      ///< sums at the end of every second from there on
};

}  // namespace endovascular_sim::results
