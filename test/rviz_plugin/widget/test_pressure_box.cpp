#include "rviz_plugin/widget/pressure_box.h"

#include <gtest/gtest.h>

#include "common/units.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

using units::kMillimetreOfMercury;

BloodState blood()
{
  BloodState state;
  state.lines.resize(2);
  state.lines[0].name = "pressure_wire";
  state.lines[0].mean = 70.0 * kMillimetreOfMercury;
  state.lines[1].name = "catheter";
  state.lines[1].highest = 115.4 * kMillimetreOfMercury;
  state.lines[1].lowest = 72.6 * kMillimetreOfMercury;
  state.lines[1].mean = 87.0 * kMillimetreOfMercury;
  state.ratio = 70.0 / 87.0;
  return state;
}

TEST(PressureBox, WritesPressuresInMillimetresOfMercury)
{
  const QString text = pressureText(blood());
  EXPECT_NE(text.indexOf("catheter <b>115/73 (87)</b>"), -1) << text.toStdString();
  EXPECT_NE(text.indexOf("pressure_wire <b>–/– (70)</b>"), -1) << text.toStdString();
}

TEST(PressureBox, NamesTheRatioFfrInHyperaemiaOnly)
{
  BloodState state = blood();
  EXPECT_EQ(ratioText(state).toStdString(), "Pd/Pa 0.80");
  state.is_reserve = true;
  EXPECT_EQ(ratioText(state).toStdString(), "FFR 0.80");
  state.ratio.reset();
  EXPECT_EQ(ratioText(state).toStdString(), "");
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
