#include <sys/wait.h>

#include <cstdlib>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include "endovascular_sim/GetVessel.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "scene/scene_vessel.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::nodes
{
namespace
{

const ros::Duration kTimeout(20.0);

template <typename Message>
boost::shared_ptr<const Message> latched(const std::string& topic)
{
  ros::NodeHandle node;
  return ros::topic::waitForMessage<Message>(topic, node, kTimeout);
}

/** The same vessel, built without the graph. */
vessel::Vessel expectedVessel()
{
  const scene::Scene scene = sceneFromParameters(ros::NodeHandle());
  return scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
}

TEST(VesselConversions, RoundTripBitForBit)
{
  const vessel::Vessel vessel = expectedVessel();
  VesselMesh mesh;
  toMessage(vessel.mesh, mesh);
  EXPECT_EQ(fromMessage(mesh).hash(), vessel.mesh.hash());
  VesselCentreline centreline;
  toMessage(vessel.centreline, centreline);
  const vessel::CentrelineTree back = fromMessage(centreline);
  ASSERT_EQ(back.branches.size(), vessel.centreline.branches.size());
  for (std::size_t b = 0; b < back.branches.size(); ++b)
  {
    EXPECT_EQ(back.branches[b].name, vessel.centreline.branches[b].name);
    EXPECT_EQ(back.branches[b].parent, vessel.centreline.branches[b].parent);
    EXPECT_EQ(back.branches[b].points, vessel.centreline.branches[b].points);
    EXPECT_EQ(back.branches[b].radii, vessel.centreline.branches[b].radii);
  }
}

TEST(VesselServer, LatchesMeshAndCentrelineWithVersionAndHash)
{
  const auto mesh = latched<VesselMesh>(names::kVesselMesh);
  const auto centreline = latched<VesselCentreline>(names::kVesselCentreline);
  ASSERT_TRUE(mesh && centreline);
  EXPECT_EQ(mesh->header.frame_id, names::kPatientFrame);
  EXPECT_EQ(mesh->version, 1U);
  EXPECT_EQ(mesh->content_hash, fromMessage(*mesh).hash());
  EXPECT_EQ(mesh->content_hash, expectedVessel().mesh.hash());
  EXPECT_EQ(centreline->content_hash, mesh->content_hash);
  EXPECT_EQ(centreline->branches.size(), 1U);
  EXPECT_TRUE(vessel::checkMesh(fromMessage(*mesh)).clean());
}

TEST(VesselServer, ReturnsTheSameVesselFromItsService)
{
  const auto mesh = latched<VesselMesh>(names::kVesselMesh);
  ASSERT_TRUE(mesh);
  ASSERT_TRUE(ros::service::waitForService(names::kGetVessel, kTimeout));
  GetVessel service;
  ASSERT_TRUE(ros::service::call(names::kGetVessel, service));
  EXPECT_EQ(service.response.mesh.content_hash, mesh->content_hash);
  EXPECT_EQ(fromMessage(service.response.mesh).hash(), mesh->content_hash);
  EXPECT_EQ(service.response.centreline.branches.size(), 1U);
}

TEST(VesselServer, PublishesATranslucentMarkerOfTheWall)
{
  const auto marker = latched<visualization_msgs::Marker>(names::kVesselMarker);
  const auto mesh = latched<VesselMesh>(names::kVesselMesh);
  ASSERT_TRUE(marker && mesh);
  EXPECT_EQ(marker->type, visualization_msgs::Marker::TRIANGLE_LIST);
  EXPECT_EQ(marker->points.size(), 3 * mesh->mesh.triangles.size());
  EXPECT_GT(marker->color.a, 0.0F);
  EXPECT_LT(marker->color.a, 1.0F);
}

TEST(VesselServer, PublishesTheFrameOfTheIntroducerAtTheEntry)
{
  const scene::Scene scene = sceneFromParameters(ros::NodeHandle());
  const scene::EntryPose entry = scene::resolveEntry(scene.entry, expectedVessel(), scene.file);
  const auto frames = latched<tf2_msgs::TFMessage>("/tf_static");
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->transforms.size(), 1U);
  const geometry_msgs::TransformStamped& transform = frames->transforms[0];
  EXPECT_EQ(transform.header.frame_id, names::kPatientFrame);
  EXPECT_EQ(transform.child_frame_id, names::kIntroducerFrame);
  const auto& q = transform.transform.rotation;
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  EXPECT_LT((rotation * Eigen::Vector3d::UnitX() - entry.direction).norm(), 1e-9);
  EXPECT_LT((rotation * Eigen::Vector3d::UnitY() - entry.d1).norm(), 1e-9);
  EXPECT_EQ(transform.transform.translation.x, entry.position.x());
}

TEST(VesselServer, NamesTheEndAtAClickInRviz)
{
  ASSERT_TRUE(latched<VesselMesh>(names::kVesselMesh));
  const vessel::CentrelineEnd end = vessel::centrelineEnds(expectedVessel().centreline).back();
  ros::NodeHandle node;
  std::string found;
  const auto listen = [&found](const rosgraph_msgs::LogConstPtr& line)
  {
    if (line->msg.rfind("clicked point: ", 0) == 0)
      found = line->msg;
  };
  const ros::Subscriber log = node.subscribe<rosgraph_msgs::Log>("/rosout", 100, listen);
  const ros::Publisher clicks = node.advertise<geometry_msgs::PointStamped>(names::kClickedPoint, 1);
  geometry_msgs::PointStamped click;
  click.header.frame_id = names::kPatientFrame;
  click.point.x = end.position.x() + 1e-3;
  click.point.y = end.position.y();
  click.point.z = end.position.z();
  for (const ros::Time limit = ros::Time::now() + kTimeout; found.empty() && ros::Time::now() < limit;)
  {
    clicks.publish(click);
    ros::Duration(0.1).sleep();
    ros::spinOnce();
  }
  EXPECT_NE(found.find(", 1.0 mm from the click"), std::string::npos) << found;
  EXPECT_NE(found.find("--set entry.nearest_centreline_end=true"), std::string::npos) << found;
}

TEST(VesselServer, PublishesDiagnostics)
{
  for (int k = 0; k < 20; ++k)
  {
    const auto diagnostics = latched<diagnostic_msgs::DiagnosticArray>(names::kDiagnostics);
    ASSERT_TRUE(diagnostics);
    for (const diagnostic_msgs::DiagnosticStatus& status : diagnostics->status)
      if (status.name.find("vessel") != std::string::npos && !status.values.empty())
      {
        EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::OK);
        return;
      }
  }
  FAIL() << "no diagnostics of the vessel server";
}

TEST(VesselServer, ExitsWithCodeOneWhenTheMeshIsInvalid)
{
  const int status = std::system("rosrun endovascular_sim vessel_server __ns:=refused __name:=refused_server");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

}  // namespace
}  // namespace endovascular_sim::nodes
