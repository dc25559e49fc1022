#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <nlohmann/json.hpp>

#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "test/nodes/graph_testing.h"

namespace endovascular_sim::nodes
{
namespace
{

using Json = nlohmann::ordered_json;

/** Session node of a namespace, as a child process that ends at the scene's duration. */
class SessionProcess
{
public:
  /** @param name namespace of the graph
   *  @param folder folder of the results */
  SessionProcess(const std::string& name, const std::string& folder)
  {
    const std::string program = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "session").string();
    const std::vector<std::string> arguments = {program,
                                                "__ns:=" + name,
                                                "__name:=session",
                                                "_results:=" + folder,
                                                "_stop_at_duration:=true",
                                                "_start_patience:=100"};
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));  // NOLINT: the interface of exec
    argv.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0)
    {
      ::execv(program.c_str(), argv.data());
      ::_exit(127);
    }
  }
  ~SessionProcess()
  {
    if (!hasEnded_)
    {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }
  SessionProcess(const SessionProcess&) = delete;
  SessionProcess& operator=(const SessionProcess&) = delete;

  /** Waits for the end. @return exit code; −1 after the time [s] or a crash */
  int exitCode(double seconds)
  {
    int status = 0;
    hasEnded_ = waitUntil(seconds, [&] { return ::waitpid(process_, &status, WNOHANG) == process_; });
    return hasEnded_ && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

private:
  pid_t process_ = -1;
  bool hasEnded_ = false;
};

/** Metrics of the offline simulation, from the contact sets that were stale in a recording.
 *  @param file bag of the session */
Json offlineMetrics(const std::string& file)
{
  const SessionBag recording = readSessionBag(file);
  EXPECT_EQ(incompleteness(recording), "");
  RecordedSimulation recorded(recording, file, true);
  for (const auto& [step, applied] : recording.steps)
  {
    if (recorded.session().isOver())
      break;
    recorded.stepByScene(*applied);
    EXPECT_EQ(recorded.simulation().stateHash(), applied->state_hash) << "step " << step;
  }
  const std::string folder = file + ".offline";
  recorded.session().finish(folder);
  std::filesystem::remove_all(folder);
  return recorded.session().record().metrics()->json();
}

std::set<std::string> errorsOf(const Json& metrics)
{
  std::set<std::string> errors;
  for (const Json& error : metrics["errors"])
    errors.insert(error["error"].get<std::string>());
  return errors;
}

/** Sessions of both graphs, which run at the same time. */
class RecordedSession : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    for (const char* name : {"treatment", "procedure"})
      sessions_[name] = std::make_unique<SessionProcess>(std::string("/") + name, folderOf(name));
  }

  static void TearDownTestSuite()
  {
    sessions_.clear();
    for (const char* name : {"treatment", "procedure"})
      std::filesystem::remove_all(folderOf(name));
  }

  static std::string folderOf(const std::string& name)
  {
    return testing::TempDir() + "/session_metrics_" + name + std::to_string(::getpid());
  }

  /** Metrics that the session node has written. */
  static Json metricsOf(const std::string& name)
  {
    EXPECT_EQ(sessions_[name]->exitCode(150.0), 0) << "see the log of /" << name << "/session";
    std::ifstream file(folderOf(name) + "/metrics.json");
    return Json::parse(file);
  }

  static void expectEqualMetrics(const std::string& name, const Json& graph)
  {
    const Json offline = offlineMetrics(folderOf(name) + "/session.bag");
    EXPECT_EQ(graph.size(), offline.size());
    for (const auto& [key, value] : offline.items())
      EXPECT_EQ(graph.value(key, Json(nullptr)).dump(1), value.dump(1)) << key;
  }

  /** Compares the errors of a session. On a busy machine contact sets come too late, and instruments move otherwise:
   * then only the equality with the offline simulation is tested. */
  static void expectErrors(const std::string& name, const Json& graph, const std::set<std::string>& errors)
  {
    const SessionBag recording = readSessionBag(folderOf(name) + "/session.bag");
    const auto stale =
        std::count_if(recording.steps.begin(), recording.steps.end(),
                      [](const auto& step) { return step.second->first_stale_pass != contact::kNoStalePass; });
    if (stale == 0)
    {
      EXPECT_EQ(errorsOf(graph), errors);
      return;
    }
    std::cout << "a busy machine: " << stale << " steps of " << name << " had contact sets of the step before\n";
  }

  static std::map<std::string, std::unique_ptr<SessionProcess>> sessions_;
};

std::map<std::string, std::unique_ptr<SessionProcess>> RecordedSession::sessions_;

TEST_F(RecordedSession, OfATreatmentHasTheMetricsOfTheOfflineSimulation)
{
  const Json graph = metricsOf("treatment");
  expectErrors(
      "treatment", graph,
      {"above_rated", "at_risk", "balloon ahead of its wire", "burst", "over_expanded", "sustained force of a tip"});
  expectEqualMetrics("treatment", graph);
}

TEST_F(RecordedSession, OfAProcedureHasTheMetricsOfTheOfflineSimulation)
{
  const Json graph = metricsOf("procedure");
  expectErrors("procedure", graph, {"risk of perforation", "stent_lost"});
  EXPECT_EQ(graph["outcome"], "failed");
  EXPECT_GT(graph["wrong_branches"].size(), 0U);
  expectEqualMetrics("procedure", graph);
}

}  // namespace
}  // namespace endovascular_sim::nodes
