#include "results/recording_notes.h"

#include <nlohmann/json.hpp>

namespace endovascular_sim::results
{

using Json = nlohmann::ordered_json;

Json toJson(const std::vector<Remark>& remarks)
{
  Json list = Json::array();
  for (const Remark& remark : remarks)
    list.push_back({{"step", remark.step}, {"time", remark.time}, {"text", remark.text}});
  return list;
}

Json toJson(const std::vector<RecordingGap>& gaps)
{
  Json list = Json::array();
  for (const RecordingGap& gap : gaps)
    list.push_back(
        {{"first_step", gap.first_step}, {"last_step", gap.last_step}, {"previous", gap.previous}, {"next", gap.next}});
  return list;
}

}  // namespace endovascular_sim::results
