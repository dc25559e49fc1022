#include "nodes/fluoroscopy/x_ray_room.h"

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "test/fluoroscopy/motion_fixtures.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::nodes
{
namespace
{

fluoroscopy::MaterialLibrary library()
{
  return fluoroscopy::MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml");
}

TEST(XRayRoom, PlacesThePatientWithTheMiddleOfTheVesselAtTheIsocentre)
{
  const scene::Scene scene =
      scene::loadScene(PROJECT_DIR "/config/scenes/tube.yaml", {"fluoroscopy={pixels: 32, follow_tip: false}"});
  XRayRoom room(scene, library());
  EXPECT_TRUE(room.awaitsVessel());
  EXPECT_FALSE(room.awaitsPatient());
  EXPECT_FALSE(room.canLoadPatient());
  geometry::TriangleMesh mesh = scene::buildVessel(*scene.vessel, scene.entry, "test").mesh;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  room.setVessel(std::move(mesh));
  EXPECT_FALSE(room.awaitsVessel());
  EXPECT_LT((room.geometry().pose().isocentre - box.center()).norm(), 1e-12);
  EXPECT_EQ(room.draw(0, false).native.pixels, 32);
}

TEST(XRayRoom, KeepsTheIsocentreOfACommandWhenTheVesselArrives)
{
  const scene::Scene scene =
      scene::loadScene(PROJECT_DIR "/config/scenes/tube.yaml", {"fluoroscopy={pixels: 32, follow_tip: false}"});
  XRayRoom room(scene, library());
  fluoroscopy::CArmPose target = room.gantry().target();
  target.isocentre = Eigen::Vector3d(0.01, 0.02, 0.03);
  room.moveTo(target, true);
  room.setVessel(scene::buildVessel(*scene.vessel, scene.entry, "test").mesh);
  room.advance(10.0);
  EXPECT_LT((room.gantry().pose().isocentre - target.isocentre).norm(), 1e-12);
}

TEST(XRayRoom, DrawsVesselAndBalloonInTheMotionOfTheState)
{
  const scene::Scene scene =
      scene::loadScene(PROJECT_DIR "/config/scenes/tube.yaml", {"fluoroscopy={pixels: 64, follow_tip: false}"});
  const Eigen::Vector3d centre = motion::naturalHeart().fade.centre;
  const geometry::TriangleMesh mesh = fluoroscopy::sphere(centre, 0.03, 20, 30);
  const std::vector<Eigen::Vector3d> balloon = {centre, centre + Eigen::Vector3d(0.02, 0.0, 0.0)};
  XRayRoom room(scene, library());
  room.setVessel(mesh);
  const std::vector<std::uint16_t> vessel_alone = room.draw(3, false).native.raw;
  ImagedState state;
  state.treatment.emplace().balloons = {{balloon, {2e-3, 2e-3}}};
  room.setState(state);
  const std::vector<std::uint16_t> at_rest = room.draw(3, false).native.raw;
  EXPECT_NE(at_rest, vessel_alone);
  state.motion = fluoroscopy::motionAt(0.3, 0.2);
  room.setState(state);
  const std::vector<std::uint16_t> moved = room.draw(3, false).native.raw;
  EXPECT_NE(moved, at_rest);
  room.setState({});
  room.draw(4, false);
  room.setState(state);
  EXPECT_EQ(room.draw(3, false).native.raw, moved);  // whatever was drawn before
  EXPECT_NE(room.draw(4, false).native.raw, moved);  // the noise is that of the pulse
}

}  // namespace
}  // namespace endovascular_sim::nodes
