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

/** Closing error of an audit in each second of the simulated time. */
class AuditClosure
{
public:
  static constexpr double kShareOfSecond = 0.02;  ///< tolerated error: share of the work of the second …
  static constexpr double kShareOfRun = 0.01;     ///< … plus this share of the work of the run

  /** Notes a balance. @param time simulated time [s], ascending */
  void add(double time, const rod::EnergyBalance& balance);

  /** Largest error of a second relative to the tolerated one, by magnitudes; at most 1: the audit closes [1]. */
  double worst() const;

  /** Second with the largest error; −1 without a row. */
  int worstSecond() const;

  /** Result as a line of text. */
  std::string text() const;

private:
  /** Balance at the end of a second. */
  struct Second
  {
    double error = 0.0;     ///< [J]
    double turnover = 0.0;  ///< [J]
  };

  double ratio(std::size_t second) const;

  std::vector<Second> ends_;
};

}  // namespace endovascular_sim::results
