#include "rviz_plugin/model/treatment_drawing.h"

#include <limits>

#include <gtest/gtest.h>

#include "nodes/visualization/motion_history.h"
#include "test/rviz_plugin/moved_patient.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

TreatmentBody body(double length, double thickness)
{
  TreatmentBody result;
  for (int i = 0; i <= 20; ++i)
  {
    geometry_msgs::Point point;
    point.z = length * i / 20.0;
    result.axis.push_back(point);
    result.radius.push_back(1.5e-3);
  }
  result.thickness = thickness;
  return result;
}

TEST(TreatmentDrawing, DrawsBalloonsAndStents)
{
  TreatmentVisual message;
  message.balloons.push_back(body(0.02, 0.0));
  message.stents.push_back(body(0.02, 1e-4));
  TreatmentDrawing drawing;
  EXPECT_EQ(drawing.update(message, nodes::restingMap()), "");
  EXPECT_FALSE(drawing.balloons().triangles.empty());
  EXPECT_FALSE(drawing.struts().triangles.empty());
  for (const Eigen::Vector3f& position : drawing.struts().positions)
    EXPECT_TRUE(position.allFinite());
  EXPECT_EQ(drawing.update({}, nodes::restingMap()), "");
  EXPECT_TRUE(drawing.balloons().positions.empty() && drawing.struts().positions.empty());
}

TEST(TreatmentDrawing, DrawsNothingForInvalidBodies)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TreatmentDrawing drawing;
  const auto reason = [&](const TreatmentBody& stent)
  {
    TreatmentVisual message;
    message.balloons.push_back(body(0.02, 0.0));
    message.stents.push_back(stent);
    const std::string result = drawing.update(message, nodes::restingMap());
    EXPECT_TRUE(drawing.balloons().positions.empty() && drawing.struts().positions.empty());
    return result;
  };
  EXPECT_EQ(reason({}), "stent: empty");
  EXPECT_EQ(reason(body(0.0, 1e-4)), "stent: implausible length");
  EXPECT_EQ(reason(body(900.0, 1e-4)), "stent: implausible length");
  EXPECT_EQ(reason(body(0.02, nan)), "stent: thickness not finite");
  TreatmentBody broken = body(0.02, 1e-4);
  broken.axis[3].x = nan;
  EXPECT_EQ(reason(broken), "stent: not finite");
  broken = body(0.02, 1e-4);
  broken.radius.clear();
  EXPECT_EQ(reason(broken), "stent: inconsistent lengths");
}

TEST(TreatmentDrawing, BodiesOfTheRestingPatientAreDrawnInTheMovedOne)
{
  const motion::MotionMap map = movedPatient();
  TreatmentVisual resting, moved;
  resting.balloons.push_back(body(0.01, 0.0));
  resting.stents.push_back(body(0.01, 1e-4));
  moved = resting;
  for (TreatmentBody* each : {&moved.balloons[0], &moved.stents[0]})
    for (geometry_msgs::Point& point : each->axis)
    {
      const Eigen::Vector3d place = map.position({point.x, point.y, point.z});
      point.x = place.x(), point.y = place.y(), point.z = place.z();
    }
  TreatmentDrawing drawing, expected, at_rest;
  EXPECT_EQ(drawing.update(resting, map), "");
  EXPECT_EQ(expected.update(moved, nodes::restingMap()), "");
  EXPECT_EQ(at_rest.update(resting, nodes::restingMap()), "");
  EXPECT_EQ(drawing.balloons().positions, expected.balloons().positions);
  EXPECT_EQ(drawing.struts().positions, expected.struts().positions);
  EXPECT_NE(drawing.balloons().positions, at_rest.balloons().positions);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
