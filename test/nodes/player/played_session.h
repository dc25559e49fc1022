#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include "common/version.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "test/common/temporary_folder.h"
#include "test/fuzz/fuzz_simulation.h"
#include "test/vessel/io/mesh_files.h"

namespace endovascular_sim::nodes
{

/** What a bag of a played session holds otherwise. */
struct PlayedFaults
{
  std::uint64_t first = 0, last = 100;  ///< states
  std::uint64_t pause_after = 1000;     ///< state that a pause of a minute follows
  std::uint64_t late = 0;  ///< number of states that were recorded together, at the time of the last of them
  bool with_steps_of_another = false;  ///< true: procedure/step has other fields
  bool without_info = false;           ///< true: session/info is missing
  bool without_end = false;            ///< true: session/end is missing
};

/** Bag of a session with every kind of topic that a player shows. State k is that of step 100·k, at 0.1·k s. */
class PlayedSession
{
public:
  static constexpr double kBegin = 1000.0;  ///< time of the recording at simulated time 0 [s]
  static constexpr double kInterval = 0.1;  ///< between two states [s]

  static std::uint64_t stepOf(std::uint64_t state) { return 100 * state; }

  /** Time of the recording at a state. */
  static ros::Time timeOf(std::uint64_t state, const PlayedFaults& faults = {})
  {
    return ros::Time(kBegin + kInterval * static_cast<double>(state) + (state > faults.pause_after ? 60.0 : 0.0));
  }

  explicit PlayedSession(std::string file, const PlayedFaults& faults = {}) : file_(std::move(file)), faults_(faults)
  {
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    bag.setChunkThreshold(4096);
    writeBeginning(bag);
    for (std::uint64_t state = faults.first; state < faults.last; ++state)
      writeState(bag, state);
    SessionEnd end;
    end.steps = stepOf(faults.last);
    if (!faults.without_end)
      write(bag, names::kSessionEnd, timeOf(faults.last, faults_), end);
    bag.close();
  }

  const std::string& file() const { return file_; }
  const VesselMesh& mesh() const { return mesh_; }

private:
  template <typename Message>
  static void write(rosbag::Bag& bag, const std::string& topic, ros::Time time, const Message& message)
  {
    bag.write((topic.front() == '/' ? "" : "/room/") + topic, time, message);
  }

  void writeBeginning(rosbag::Bag& bag)
  {
    const fuzz::SmallSimulation small;
    const ros::Time begin = timeOf(faults_.first, faults_) - ros::Duration(0.01);
    toMessage(vessel::capsule(3, 1), mesh_);
    mesh_.version = 1;
    SessionInfo info;
    info.scene_name = "small";
    info.scene_yaml = small.scene.resolved_yaml;
    info.scene_hash = small.scene.hash();
    info.mesh_hash = mesh_.content_hash;
    info.time_step = small.scene.solver.time_step;
    info.physics_number = kPhysicsNumber;
    if (!faults_.without_info)
      write(bag, names::kSessionInfo, begin, info);
    write(bag, names::kVesselMesh, begin, mesh_);
    for (const char* frame : {"introducer", "table"})
      writePoses(bag, "/tf_static", begin, {frame}, 0.0);
  }

  static void writePoses(rosbag::Bag& bag, const std::string& topic, ros::Time time,
                         const std::vector<std::string>& frames, double x)
  {
    tf2_msgs::TFMessage poses;
    for (const std::string& frame : frames)
    {
      geometry_msgs::TransformStamped pose;
      pose.header.stamp = time;
      pose.header.frame_id = "patient";
      pose.child_frame_id = frame;
      pose.transform.translation.x = x;
      pose.transform.rotation.w = 1.0;
      poses.transforms.push_back(pose);
    }
    write(bag, topic, time, poses);
  }

  void writeState(rosbag::Bag& bag, std::uint64_t k) const
  {
    const ros::Time time = timeOf(k + 1 < faults_.late ? faults_.late - 1 : k, faults_);
    const auto number = static_cast<double>(k);
    RodStateVisual rod;
    rod.header.stamp = time;
    rod.step = stepOf(k);
    rod.time = kInterval * number;
    rod.insertion = {0.001 * number};
    rod.hand_force = {k == 40 ? -2.0 : 0.5};
    rod.nodes.resize(2);
    rod.radius = {1e-4, 1e-4};
    rod.contact_force.resize(2);
    rod.contact_force[1].y = k == 30 ? 0.3 : 0.01;
    write(bag, names::kRodStateVisual, time, rod);
    TreatmentVisual treatment;
    treatment.step = rod.step;
    treatment.time = rod.time;
    write(bag, names::kTreatmentVisual, time + ros::Duration(0.002), treatment);
    writePoses(bag, "/tf", time + ros::Duration(0.003), {"wire_tip"}, number);
    if (k % 7 == 0)
      writePoses(bag, "/tf", time + ros::Duration(0.004), {"link_1", "link_2"}, number);
    SessionSample sample;
    sample.step = rod.step + 50;
    sample.time = rod.time + 0.05;
    for (std::vector<double>* values : {&sample.insertion, &sample.rotation, &sample.tip_rotation, &sample.hand_force,
                                        &sample.hand_torque, &sample.pressure, &sample.peak_hand_torque})
      *values = {0.0};
    sample.tip.resize(1);
    sample.peak_hand_force = {k == 60 ? 3.0 : 0.1};
    write(bag, names::kSessionSample, time + ros::Duration(0.05), sample);
    DriveApplied applied;
    applied.step = k;  // a step of every state, so that a survey finds no gap
    write(bag, names::kDriveApplied, time, applied);
    if (k >= 20)
      writeDisplacement(bag, k, time);
    if (k % 5 == 0 && k >= 10)
      writeForceMap(bag, k, time);
    if (k % 25 == 0)
      writeStep(bag, k, time);
    if (k == 55)
      writeMark(bag, k, time);
    if (k == 33)
    {
      CArm command;
      command.view = "LAO 40";
      write(bag, names::kCArmCommand, time, command);
    }
  }

  void writeDisplacement(rosbag::Bag& bag, std::uint64_t k, ros::Time time) const
  {
    WallDisplacement moved;
    moved.step = stepOf(k);
    moved.version = k - 18;
    moved.index = {static_cast<std::uint32_t>(k % mesh_.mesh.vertices.size()), 2};
    moved.position.resize(2);
    moved.position[0].x = 1e-3 * static_cast<double>(k);
    moved.position[1].z = 1e-4 * static_cast<double>(k);
    write(bag, names::kWallDisplacement, time + ros::Duration(0.001), moved);
  }

  void writeForceMap(rosbag::Bag& bag, std::uint64_t k, ros::Time time) const
  {
    ContactForceMap map;
    map.step = stepOf(k);
    map.time = kInterval * static_cast<double>(k);
    map.content_hash = mesh_.content_hash;
    map.triangles = {1};
    map.peak = {0.01F * static_cast<float>(k)};
    write(bag, names::kContactForceMap, time, map);
  }

  void writeStep(rosbag::Bag& bag, std::uint64_t k, ros::Time time) const
  {
    ProcedureStep step;
    step.begun = static_cast<std::uint32_t>(k / 25 + 1);
    step.phase = "Phase " + std::to_string(k / 25);
    step.name = "advance wire";
    step.begin = step.time = kInterval * static_cast<double>(k);
    step.wrong_branches = k == 50 ? 1 : 0;
    if (!faults_.with_steps_of_another)
    {
      write(bag, names::kProcedureStep, time, step);
      return;
    }
    topic_tools::ShapeShifter other;
    other.morph(std::string(32, '5'), "endovascular_sim/ProcedureStep", "float64 other", "0");
    std::vector<std::uint8_t> bytes(8);
    ros::serialization::IStream in(bytes.data(), 8);
    other.read(in);
    write(bag, names::kProcedureStep, time, other);
  }

  /** Remark: header, step, time and text. */
  static void writeMark(rosbag::Bag& bag, std::uint64_t k, ros::Time time)
  {
    const std_msgs::Header header;
    const std::string text = "look here";
    std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(header) + 8 + 8 + 4 + text.size());
    ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    out.next(header);
    out.next(stepOf(k));
    out.next(kInterval * static_cast<double>(k));
    out.next(text);
    topic_tools::ShapeShifter mark;
    mark.morph(std::string(32, '7'), "endovascular_sim/SessionMark",
               "Header header\nuint64 step\nfloat64 time\nstring text\n", "0");
    ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    mark.read(in);
    write(bag, "session/mark", time, mark);
  }

  std::string file_;
  PlayedFaults faults_;
  VesselMesh mesh_;
};

}  // namespace endovascular_sim::nodes
