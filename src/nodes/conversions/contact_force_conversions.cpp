#include "nodes/conversions/contact_force_conversions.h"

#include <algorithm>
#include <limits>

#include "nodes/conversions/contact_conversions.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint16_t kNoRegionInMessage = std::numeric_limits<std::uint16_t>::max();

void toMessage(const results::WallForceTotals& totals, ContactForceTotals& message)
{
  message.region = regionToMessage(totals.region);
  message.name = totals.name;
  message.peak = totals.peak;
  message.peak_position = toPoint(totals.peak_position);
  message.peak_region = regionToMessage(totals.peak_region);
  message.peak_time = totals.peak_time;
  message.peak_sum = totals.peak_sum;
  message.peak_sum_time = totals.peak_sum_time;
  message.integral = totals.integral;
  message.time_over_threshold = totals.time_over_threshold;
}

results::WallForceTotals totalsFromMessage(const ContactForceTotals& message)
{
  results::WallForceTotals totals;
  totals.region = regionFromMessage(message.region);
  totals.name = message.name;
  totals.peak = message.peak;
  totals.peak_position = fromMessage(message.peak_position);
  totals.peak_region = regionFromMessage(message.peak_region);
  totals.peak_time = message.peak_time;
  totals.peak_sum = message.peak_sum;
  totals.peak_sum_time = message.peak_sum_time;
  totals.integral = message.integral;
  totals.time_over_threshold = message.time_over_threshold;
  return totals;
}

}  // namespace

std::uint16_t regionToMessage(int region)
{
  return region >= 0 && region < kNoRegionInMessage ? static_cast<std::uint16_t>(region) : kNoRegionInMessage;
}

int regionFromMessage(std::uint16_t region)
{
  return region == kNoRegionInMessage ? results::kNoRegion : region;
}

void toMessage(const results::WallForceSummary& summary, const std::vector<results::WallForce>& touched,
               ContactForceMap& message)
{
  message.time = summary.time;
  message.threshold = summary.threshold;
  toMessage(summary.whole, message.whole);
  message.regions.resize(summary.regions.size());
  for (std::size_t k = 0; k < summary.regions.size(); ++k)
    toMessage(summary.regions[k], message.regions[k]);
  const std::size_t count = touched.size();
  message.triangles.resize(count);
  message.triangle_regions.resize(count);
  message.peak.resize(count);
  message.peak_time.resize(count);
  message.integral.resize(count);
  message.time_over_threshold.resize(count);
  for (std::size_t k = 0; k < count; ++k)
  {
    message.triangles[k] = static_cast<std::uint32_t>(touched[k].triangle);
    message.triangle_regions[k] = regionToMessage(touched[k].region);
    message.peak[k] = static_cast<float>(touched[k].peak);
    message.peak_time[k] = static_cast<float>(touched[k].peak_time);
    message.integral[k] = static_cast<float>(touched[k].integral);
    message.time_over_threshold[k] = static_cast<float>(touched[k].time_over_threshold);
  }
}

results::WallForceSummary summaryFromMessage(const ContactForceMap& message)
{
  results::WallForceSummary summary;
  summary.time = message.time;
  summary.threshold = message.threshold;
  summary.whole = totalsFromMessage(message.whole);
  for (const ContactForceTotals& totals : message.regions)
    summary.regions.push_back(totalsFromMessage(totals));
  return summary;
}

std::vector<results::WallForce> touchedFromMessage(const ContactForceMap& message)
{
  const std::size_t count =
      std::min({message.triangles.size(), message.triangle_regions.size(), message.peak.size(),
                message.peak_time.size(), message.integral.size(), message.time_over_threshold.size()});
  std::vector<results::WallForce> touched(count);
  for (std::size_t k = 0; k < count; ++k)
  {
    touched[k].triangle = static_cast<int>(message.triangles[k]);
    touched[k].region = regionFromMessage(message.triangle_regions[k]);
    touched[k].peak = message.peak[k];
    touched[k].peak_time = message.peak_time[k];
    touched[k].integral = message.integral[k];
    touched[k].time_over_threshold = message.time_over_threshold[k];
  }
  return touched;
}

}  // namespace endovascular_sim::nodes
