#include "rviz_plugin/model/treatment_drawing.h"

#include <limits>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
