#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "common/version.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "test/fuzz/fuzz_simulation.h"
#include "test/vessel/io/mesh_files.h"

namespace endovascular_sim::fuzz
{

constexpr std::uint64_t kSessionSteps = 3;     ///< steps of the small session
constexpr std::uint32_t kSessionChunk = 1024;  ///< size at which a chunk of its bag ends [B]

/** Writes a message with the time 1 s. */
template <typename Message>
void writeAt(rosbag::Bag& bag, const char* topic, const Message& message)
{
  bag.write(std::string("/") + topic, ros::Time(1.0), message);
}

inline void writeSessionStart(rosbag::Bag& bag, const SmallSimulation& small)
{
  VesselMesh mesh;
  nodes::toMessage(vessel::capsule(3, 1), mesh);
  SessionInfo info;
  info.scene_yaml = small.scene.resolved_yaml;
  info.scene_hash = small.scene.hash();
  info.mesh_hash = mesh.content_hash;
  info.time_step = small.scene.solver.time_step;
  info.physics_number = kPhysicsNumber;
  writeAt(bag, nodes::names::kSessionInfo, info);
  writeAt(bag, nodes::names::kVesselMesh, mesh);
}

inline void writeSessionStep(rosbag::Bag& bag, SmallSimulation& small, std::uint64_t step)
{
  const std::vector<drive::HandCommand> commands =
      simulation::commandsAt(small.scene, static_cast<double>(step + 1) * small.scene.solver.time_step);
  small.simulation.stepAll(commands);
  DriveApplied applied;
  applied.step = step;
  for (const drive::HandCommand& command : commands)
  {
    applied.insertion.push_back(command.insertion);
    applied.rotation.push_back(command.rotation);
    applied.pressure.push_back(command.pressure);
  }
  applied.state_hash = small.simulation.stateHash();
  writeAt(bag, nodes::names::kDriveApplied, applied);
}

/** Records a session of kSessionSteps steps without a vessel in its scene; the bag also holds a mesh.
 *  @return hash of the trajectory */
inline std::uint64_t writeSmallSession(const std::string& file, rosbag::CompressionType compression)
{
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  bag.setCompression(compression);
  bag.setChunkThreshold(kSessionChunk);
  SmallSimulation small;
  writeSessionStart(bag, small);
  for (std::uint64_t step = 0; step < kSessionSteps; ++step)
    writeSessionStep(bag, small, step);
  SessionEnd end;
  end.steps = kSessionSteps;
  writeAt(bag, nodes::names::kSessionEnd, end);
  bag.close();
  return small.simulation.trajectoryHash();
}

}  // namespace endovascular_sim::fuzz
