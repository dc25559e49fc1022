#include "nodes/fluoroscopy/x_ray_room.h"

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

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
  EXPECT_EQ(room.render(false).pixels, 32);
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

}  // namespace
}  // namespace endovascular_sim::nodes
