#include "rviz_plugin/model/pending_calls.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <list>
#include <mutex>
#include <thread>

namespace endovascular_sim::rviz_plugin
{

/** Outlives the object while a call does not return. */
struct PendingCalls::Data
{
  struct Call
  {
    Request request;
    std::string name;
    std::chrono::steady_clock::time_point begin;
  };

  std::mutex mutex;
  std::list<Call> calls;
  std::string answer;
};

std::shared_ptr<PendingCalls::Data> PendingCalls::makeData()
{
  return std::make_shared<Data>();
}

bool PendingCalls::begin(Request request, const std::string& name, const std::function<CallOutcome()>& call)
{
  std::list<Data::Call>::iterator own;
  {
    const std::lock_guard<std::mutex> lock(data_->mutex);
    const auto equal = std::count_if(data_->calls.begin(), data_->calls.end(),
                                     [request](const Data::Call& other) { return other.request == request; });
    const bool is_repeated = request == Request::kStart || request == Request::kPause;
    if (equal >= (is_repeated ? kMostRepeated : 1))
      return false;
    own = data_->calls.insert(data_->calls.end(), {request, name, std::chrono::steady_clock::now()});
    data_->answer.clear();
  }
  std::thread(
      [data = data_, call, own]
      {
        CallOutcome outcome;
        try
        {
          outcome = call();
        }
        catch (const std::exception& error)
        {
          outcome.text = error.what();
        }
        const std::lock_guard<std::mutex> lock(data->mutex);
        data->calls.erase(own);
        data->answer = outcome.text;
      })
      .detach();
  return true;
}

std::vector<std::string> PendingCalls::waiting() const
{
  std::vector<std::string> texts;
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard<std::mutex> lock(data_->mutex);
  for (const Data::Call& call : data_->calls)
    texts.push_back(call.name + " (" +
                    std::to_string(std::chrono::duration_cast<std::chrono::seconds>(now - call.begin).count()) + " s)");
  return texts;
}

std::string PendingCalls::answer() const
{
  const std::lock_guard<std::mutex> lock(data_->mutex);
  return data_->answer;
}

}  // namespace endovascular_sim::rviz_plugin
