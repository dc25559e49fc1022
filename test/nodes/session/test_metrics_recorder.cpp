#include "nodes/session/metrics_recorder.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/polyline.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Scene of a stent in a tube of 1.6 mm radius with a stenosis of 60 %. */
class RecordedStent : public testing::Test
{
protected:
  RecordedStent()
    : scene_(scene::loadScene(PROJECT_DIR "/config/scenes/stent.yaml", {})),
      vessel_(scene::buildVessel(*scene_.vessel, scene_.entry, "test", scene::CentrelineUse::kRequired)),
      recorder_(scene_),
      folder_(testing::TempDir() + "/metrics_recorder")
  {
    VesselMesh mesh;
    toMessage(vessel_.mesh, mesh);
    recorder_.add(mesh);
    VesselCentreline centreline;
    toMessage(vessel_.centreline, centreline);
    toMessage(vessel_.lesions, centreline);
    recorder_.add(centreline);
  }

  /** Displaces the narrowed wall to the radius of the tube. */
  void open()
  {
    const geometry::Polyline axis(vessel_.centreline.branches[0].points);
    intervention::WallDisplacement displacement;
    for (std::size_t i = 0; i < vessel_.mesh.vertices.size(); ++i)
    {
      const Eigen::Vector3d& vertex = vessel_.mesh.vertices[i];
      const geometry::Polyline::Foot foot = axis.nearest(vertex);
      if (foot.arc < vessel_.lesions[0].begin || foot.arc > vessel_.lesions[0].end)
        continue;
      displacement.indices.push_back(static_cast<int>(i));
      displacement.positions.emplace_back(foot.point + kRadius * (vertex - foot.point).normalized());
    }
    WallDisplacement message;
    toMessage(displacement, message);
    recorder_.add(message);
  }

  /** Adds a stent along the lesion. */
  void place(bool opened)
  {
    const geometry::Polyline axis(vessel_.centreline.branches[0].points);
    TreatmentVisual message;
    message.stents.emplace_back();
    for (const double arc : {vessel_.lesions[0].begin, vessel_.lesions[0].middle, vessel_.lesions[0].end})
    {
      message.stents[0].axis.push_back(toPoint(axis.at(arc)));
      message.stents[0].radius.push_back(kRadius);
    }
    message.stents[0].opened = opened;
    recorder_.add(message);
  }

  nlohmann::json lesion()
  {
    std::filesystem::create_directories(folder_);
    recorder_.write(folder_, nullptr);
    std::ifstream file(folder_ + "/metrics.json");
    return nlohmann::json::parse(file)["lesions"][0];
  }

  static constexpr double kRadius = 1.6e-3;
  scene::Scene scene_;
  vessel::Vessel vessel_;
  MetricsRecorder recorder_;
  std::string folder_;
};

TEST_F(RecordedStent, ReportsTheSameStenosisBeforeAndAfterWithoutTreatment)
{
  const nlohmann::json json = lesion();
  EXPECT_EQ(json["branch"], "tube");
  EXPECT_NEAR(json["before"]["stenosis"].get<double>(), 0.6, 0.05);
  EXPECT_EQ(json["after"]["stenosis"], json["before"]["stenosis"]);
  EXPECT_FALSE(json["after"]["stented"].get<bool>());
}

TEST_F(RecordedStent, EvaluatesTheLesionInTheDisplacedWall)
{
  open();
  place(true);
  const nlohmann::json json = lesion();
  EXPECT_NEAR(json["before"]["stenosis"].get<double>(), 0.6, 0.05);
  EXPECT_NEAR(json["after"]["stenosis"].get<double>(), 0.0, 0.05);
  EXPECT_NEAR(json["after"]["coverage"].get<double>(), 1.0, 0.01);
  EXPECT_NEAR(json["after"]["placement_error"].get<double>(), 0.0, 0.2e-3);
}

TEST_F(RecordedStent, IgnoresACrimpedStent)
{
  place(false);
  EXPECT_FALSE(lesion()["after"]["stented"].get<bool>());
}

TEST_F(RecordedStent, ListsTheErrorsOfTheTreatmentsWhileTheyHappen)
{
  EXPECT_TRUE(recorder_.errors().empty());
  TreatmentVisual message;
  message.event = {"stent_placed", "above_rated"};
  message.event_time = {2.0, 3.0};
  message.event_instrument = {0, 0};
  recorder_.add(message);
  const std::vector<results::SessionError> errors = recorder_.errors();
  ASSERT_EQ(errors.size(), 1U) << "a placed stent is no error";
  EXPECT_EQ(errors[0].kind, "above_rated");
  EXPECT_EQ(errors[0].time, 3.0);
}

TEST_F(RecordedStent, IgnoresDisplacementsBeforeTheVessel)
{
  MetricsRecorder early(scene_);
  WallDisplacement message;
  message.index.push_back(5);
  message.position.emplace_back();
  EXPECT_NO_THROW(early.add(message));
}

}  // namespace
}  // namespace endovascular_sim::nodes
