#include <string>

#include "common/text/format.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

std::string inMillimetres(double length)
{
  return formatted("%.4ge-3 m", 1e3 * length);
}

/** Visits a table of two columns, stored as a vector of structures with two numbers. */
template <typename Row>
void visitTable(yaml::Fields& fields, const std::string& key, std::vector<Row>& table, double Row::*x, double Row::*y,
                const Quantity& x_quantity, const Quantity& y_quantity)
{
  std::vector<std::vector<double>> rows;
  rows.reserve(table.size());
  for (const Row& row : table)
    rows.push_back({row.*x, row.*y});
  fields.rows(key, rows, {x_quantity, y_quantity}, Need::kRequired);
  if (!fields.reading())
    return;
  table.clear();
  for (const std::vector<double>& row : rows)
  {
    Row entry;
    entry.*x = row[0];
    entry.*y = row[1];
    table.push_back(entry);
  }
}

void checkCompliance(const yaml::Fields& fields, const instrument::Balloon& balloon)
{
  if (balloon.compliance.size() < 2)
    fields.reject("compliance", "needs two rows or more of [pressure in Pa, diameter in m]");
  instrument::Balloon::Compliance previous{0.0, balloon.folded_diameter};
  for (std::size_t k = 0; k < balloon.compliance.size(); ++k)
  {
    const instrument::Balloon::Compliance& row = balloon.compliance[k];
    const std::string key = "compliance." + std::to_string(k);
    if (row.pressure <= previous.pressure)
      fields.reject(key, k == 0 ? "the pressure must be positive, in Pa above blood pressure"
                                : "pressures must increase from row to row; sort the rows");
    if (row.diameter <= previous.diameter)
      fields.reject(
          key, k == 0 ? "the diameter must be greater than folded_diameter, " + inMillimetres(balloon.folded_diameter)
                      : "a balloon does not shrink under pressure: diameters must increase from row to row");
    previous = row;
  }
}

void checkPressures(const yaml::Fields& fields, const instrument::Balloon& balloon)
{
  if (balloon.nominal_pressure < balloon.compliance.front().pressure ||
      balloon.nominal_pressure > balloon.compliance.back().pressure)
    fields.reject("nominal_pressure", "lies outside the compliance table; must be between its first and last pressure");
  if (balloon.rated_burst_pressure < balloon.nominal_pressure)
    fields.reject("rated_burst_pressure", "must be at least nominal_pressure");
  if (balloon.burst_pressure < balloon.rated_burst_pressure)
    fields.reject("burst_pressure", "must be at least rated_burst_pressure");
}

void checkStent(const yaml::Fields& fields, const instrument::Stent& stent)
{
  for (std::size_t k = 0; k < stent.expansion.size(); ++k)
  {
    const auto& row = stent.expansion[k];
    const std::string key = "expansion." + std::to_string(k);
    if (row.diameter <= 0.0 || row.length <= 0.0)
      fields.reject(key, "diameter and length must be positive, in m");
    if (k > 0 && row.diameter <= stent.expansion[k - 1].diameter)
      fields.reject(key, "diameters must increase from row to row; sort the rows");
    if (k > 0 && row.length > stent.expansion[k - 1].length)
      fields.reject(key, "a stent does not lengthen as it opens: lengths must not increase from row to row");
  }
  if (stent.expansion.size() < 2)
    fields.reject("expansion", "needs two rows or more of [inner diameter in m, length in m]");
  if (stent.nominal_diameter <= stent.expansion.front().diameter || stent.nominal_diameter > stent.largestDiameter())
    fields.reject("nominal_diameter",
                  "lies outside the table; must be greater than the first and at most the last "
                  "diameter of expansion");
  if (stent.crimped_diameter >= stent.nominal_diameter)
    fields.reject("crimped_diameter", "must be less than nominal_diameter, " + inMillimetres(stent.nominal_diameter));
  if (2.0 * stent.strut_thickness >= stent.crimped_diameter)
    fields.reject("strut_thickness", "must be less than half of crimped_diameter");
}

}  // namespace

void visitBalloon(yaml::Fields& fields, instrument::Instrument& instrument)
{
  if (!instrument.balloon)
    instrument.balloon.emplace();
  instrument::Balloon& balloon = *instrument.balloon;
  const double shaft = instrument.wire.length();
  const auto visit = [&balloon, shaft](yaml::Fields& keys)
  {
    const Range positive = Range::positive();
    keys.number("from_tip", balloon.from_tip, quantities::kFromTip, Range::nonNegative(), Need::kRequired);
    keys.number("length", balloon.length, quantities::kBalloonLength, positive, Need::kRequired);
    keys.number("folded_diameter", balloon.folded_diameter, quantities::kBalloonDiameter, positive, Need::kRequired);
    visitTable(keys, "compliance", balloon.compliance, &instrument::Balloon::Compliance::pressure,
               &instrument::Balloon::Compliance::diameter, quantities::kPressure, quantities::kBalloonDiameter);
    keys.number("nominal_pressure", balloon.nominal_pressure, quantities::kPressure, positive, Need::kRequired);
    keys.number("rated_burst_pressure", balloon.rated_burst_pressure, quantities::kPressure, positive, Need::kRequired);
    keys.number("burst_pressure", balloon.burst_pressure, quantities::kPressure, positive, Need::kRequired);
    keys.number("inflation_time", balloon.inflation_time, quantities::kWait, positive, Need::kRequired);
    keys.number("deflation_time", balloon.deflation_time, quantities::kWait, positive, Need::kRequired);
    if (!keys.reading())
      return;
    if (balloon.from_tip + balloon.length > shaft)
      keys.reject("from_tip", "the balloon lies beyond the shaft; from_tip + length must be at most its length, " +
                                  std::to_string(shaft) + " m");
    checkCompliance(keys, balloon);
    checkPressures(keys, balloon);
  };
  fields.map("balloon", visit);
}

void visitStent(yaml::Fields& fields, instrument::Instrument& instrument)
{
  if (!instrument.stent)
    instrument.stent.emplace();
  instrument::Stent& stent = *instrument.stent;
  const auto visit = [&instrument, &stent](yaml::Fields& keys)
  {
    const Range positive = Range::positive();
    keys.number("crimped_diameter", stent.crimped_diameter, quantities::kBalloonDiameter, positive, Need::kRequired);
    keys.number("nominal_diameter", stent.nominal_diameter, quantities::kBalloonDiameter, positive, Need::kRequired);
    keys.number("strut_thickness", stent.strut_thickness, quantities::kStrutThickness, positive, Need::kRequired);
    keys.number("recoil", stent.recoil, quantities::kFraction, Range::between(0.0, 0.5), Need::kRequired);
    visitTable(keys, "expansion", stent.expansion, &instrument::Stent::Expansion::diameter,
               &instrument::Stent::Expansion::length, quantities::kBalloonDiameter, quantities::kStentLength);
    if (!keys.reading())
      return;
    checkStent(keys, stent);
    if (instrument.balloon && stent.crimpedLength() > instrument.balloon->length)
      keys.reject("", "the stent is longer than its balloon, " + inMillimetres(instrument.balloon->length) +
                          "; give a longer balloon or a shorter stent");
  };
  fields.map("stent", visit);
}

}  // namespace endovascular_sim::scene
