#include "segmentation/lumen/edge_model.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::segmentation
{
namespace
{

/** Value of a blurred disc of radius a at the distance r from its centre, by integration over the plane. */
double blurredDisc(double r, double a, double spread)
{
  const int n = 600;
  const double h = 2.0 * a / n;
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
    {
      const double x = -a + (i + 0.5) * h;
      const double y = -a + (j + 0.5) * h;
      if (x * x + y * y < a * a)
        sum += std::exp(-0.5 * ((x - r) * (x - r) + y * y) / (spread * spread));
    }
  return sum * h * h / (2.0 * M_PI * spread * spread);
}

TEST(EdgeModel, IsThatOfABlurredDisc)
{
  const double spread = 3.75e-4;
  const EdgeModel model(spread, 8e-4);
  for (const double radius : {3.75e-4, 7e-4, 1e-3, 1.5e-3, 3e-3})
  {
    EXPECT_NEAR(model.discAtEdge(radius), blurredDisc(radius, radius, spread), 2e-3) << radius;
    EXPECT_NEAR(model.discInMiddle(radius), blurredDisc(0.0, radius, spread), 2e-3) << radius;
  }
  EXPECT_NEAR(model.discAtEdge(1.0), 0.5, 1e-3);
}

TEST(EdgeModel, TakesTheShareBehindTheWallFromAnAsymptote)
{
  const double spread = 3.75e-4;
  for (const double wall : {6e-4, 8e-4})
    for (const double radius : {7e-4, 1e-3, 1.5e-3})
      EXPECT_NEAR(EdgeModel(spread, wall).beyondWall(radius), 1.0 - blurredDisc(radius, radius + wall, spread), 0.012);
  EXPECT_EQ(EdgeModel(spread, 0.0).beyondWall(1e-3), 0.0);
}

TEST(EdgeModel, HasTheShareOfBoneBehindAGap)
{
  const EdgeModel model(3.75e-4, 8e-4);
  EXPECT_NEAR(model.beyondGap(0.0), 0.5, 1e-12);
  EXPECT_NEAR(model.beyondGap(3.75e-4), 0.158655, 1e-6);
  EXPECT_NEAR(model.beyondGap(1.0), 0.0, 1e-12);
}

TEST(EdgeModel, InvertsTheValueInTheMiddle)
{
  const EdgeModel model(3.75e-4, 8e-4);
  for (const double radius : {1e-4, 3e-4, 9e-4})
    EXPECT_NEAR(model.radiusOfMiddle(model.discInMiddle(radius)), radius, 1e-9);
}

TEST(EdgeModel, HasTheBesselFunctionOfTables)
{
  EXPECT_NEAR(scaledBesselI0(0.0), 1.0, 1e-9);
  EXPECT_NEAR(scaledBesselI0(1.0), std::exp(-1.0) * 1.2660658778, 1e-6);
  EXPECT_NEAR(scaledBesselI0(10.0), std::exp(-10.0) * 2815.716628, 1e-6);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
