#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "endovascular_sim/SessionProgress.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/SessionVerdict.h"
#include "rviz_plugin/model/error_watch.h"
#include "rviz_plugin/model/pending_calls.h"
#include "rviz_plugin/model/player_remote.h"
#include "rviz_plugin/model/session_port.h"
#include "vessel/centreline/branch_finder.h"

namespace endovascular_sim::rviz_plugin
{

/** Connection to a session by its topics and services. Messages are received in a thread of its own, velocities sent in
 * a second one, and services called in further ones (PendingCalls). */
class SessionClient : public SessionPort
{
public:
  explicit SessionClient(const ros::NodeHandle& node);
  ~SessionClient() override;

  SessionState state() const override;
  void hold(const HandVelocity& velocity) override { commander_->hold(velocity); }
  void confirm() override { commander_->confirm(); }
  void request(Request request) override;
  void changePressure(const std::string& instrument, double difference) override;
  void moveCArm(const std::string& view) override;
  void setSubject(const std::string& subject) override;
  void alignExpert(std::uint8_t alignment) override;
  void setBlood(const BloodRequest& request) override;
  void setMotion(const MotionRequest& request) override;
  void inject(const ContrastRequest& request) override;
  void controlPlayer(std::uint8_t command, double value) override { player_->give(command, value); }

private:
  using Clock = std::chrono::steady_clock;

  /** Run of the recording; outlives the client while a call does not return. */
  struct RecordedRun
  {
    std::mutex mutex;
    unsigned run = 0;          ///< of the recording
    unsigned stopped_run = 0;  ///< run whose recording was stopped
  };

  struct Diagnosis
  {
    std::string text;
    bool is_error = false;  ///< false: a warning
    Clock::time_point received;
  };

  /** Topics of one instrument. */
  struct Topics
  {
    ros::Publisher servo_jv, servo_jr;
    ros::Subscriber operating_state, state_reason;
    std::optional<drive::ControlState> state;
    std::string reason;
  };

  void subscribe();
  void subscribeToMotion();
  void subscribeToContrast();
  void receiveScene(const SessionInfoConstPtr& info);
  void receiveWire(const RodStateVisualConstPtr& message);
  void findBranch();
  void beginRun(double time);
  void receiveSample(const SessionSampleConstPtr& message);
  void receiveStep(const ProcedureStepConstPtr& message);
  void receiveProgress(const SessionProgressConstPtr& message);
  void receiveVerdict(const SessionVerdict& message);
  void noteForces(const std::vector<double>& forces);
  void noteError(const std::string& error);
  void receivePlayer(const PlayerStateConstPtr& message);
  void receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message);
  void connectInstruments(const SceneSummary& scene);
  void searchInstruments();
  void send(const HandVelocity& velocity);
  void publish(const std::string& instrument, bool is_relative, const sensor_msgs::JointState& command);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  mutable std::mutex mutex_;  ///< of the members up to the next blank line
  SessionState state_;
  Clock::time_point wire_received_, branch_found_, error_noted_, player_received_;
  std::optional<Eigen::Vector3d> tip_;  ///< the foremost one, in the resting patient [m]
  ErrorWatch errors_;
  PressureMonitor pressure_;
  MotionMonitor motion_;
  ContrastMonitor contrast_;
  vessel::BranchFinder branches_{vessel::CentrelineTree()};
  std::map<std::string, std::shared_ptr<Topics>> instruments_;
  std::map<std::string, Diagnosis> diagnoses_;

  std::shared_ptr<RecordedRun> recording_ = std::make_shared<RecordedRun>();
  PendingCalls calls_;
  ros::Publisher c_arm_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer search_;
  ros::AsyncSpinner spinner_;
  std::unique_ptr<VelocityCommander> commander_;
  std::unique_ptr<PlayerRemote> player_;
};

}  // namespace endovascular_sim::rviz_plugin
