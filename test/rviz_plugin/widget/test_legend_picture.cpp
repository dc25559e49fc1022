#include "rviz_plugin/widget/legend_picture.h"

#include <gtest/gtest.h>

#include "test/rviz_plugin/widget/widget_test.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

class LegendPictureTest : public WidgetTest
{
protected:
  static QImage picture(double full)
  {
    return legendPicture("Wall: peak force", visualization::legendScale(full, "N"),
                         [full](double value) { return value < 0.5 * full ? left : right; });
  }

  static constexpr visualization::Colour left{0.0F, 0.0F, 1.0F}, right{1.0F, 0.0F, 0.0F};
};

TEST_F(LegendPictureTest, ShowsTheColoursFromTheSmallestToTheLargestValue)
{
  const QImage image = picture(2.0);
  const int y = image.height() / 2;
  EXPECT_EQ(QColor(image.pixel(image.width() / 5, y)), QColor(Qt::blue));
  EXPECT_EQ(QColor(image.pixel(image.width() * 4 / 5, y)), QColor(Qt::red));
}

TEST_F(LegendPictureTest, BothLegendsStandBesideEachOtherInTheVesselViewOfALesson)
{
  EXPECT_LE(legendsSize().width(), 311);  // of the view at 1280 x 800
  EXPECT_LE(legendsSize().height(), 800 / 15);
  const QImage image = picture(0.05);
  EXPECT_GE(legendPlace(1).x(), legendPlace(0).x() + image.width());
  EXPECT_LE(legendPlace(1).x() + image.width(), legendsSize().width());
  EXPECT_LE(legendPlace(1).y() + image.height(), legendsSize().height());
}

TEST_F(LegendPictureTest, LettersFitIntoTheLegend)
{
  for (const char* title : {"Wall: peak force", "Instrument: force", "Wall: time over the threshold"})
  {
    const QImage image = legendPicture(title, visualization::legendScale(0.5, "N"),
                                       [](double /*value*/) { return visualization::Colour{}; });
    for (int y = 0; y < image.height(); ++y)
      EXPECT_LT(QColor(image.pixel(image.width() - 1, y)).lightness(), 100) << title << ": cut at its right edge";
  }
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
