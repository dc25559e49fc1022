#include "rviz_plugin/widget/x_ray_view.h"

#include <gtest/gtest.h>
#include <QApplication>

#include "test/rviz_plugin/widget/widget_test.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

class XRayViewTest : public WidgetTest
{
protected:
  XRayViewTest()
  {
    view.resize(600, 800);
    QImage image(256, 256, QImage::Format_Grayscale8);
    image.fill(128);
    view.showImage(image);
  }

  /** Number of pixels of the colour of the marks in a part of the picture. */
  int marked(const QRect& part)
  {
    const QImage picture = view.grab().toImage();
    int count = 0;
    for (int x = part.left(); x <= part.right(); ++x)
      for (int y = part.top(); y <= part.bottom(); ++y)
      {
        const QColor colour(picture.pixel(x, y));
        count += colour.red() > 200 && colour.blue() < 200 ? 1 : 0;
      }
    return count;
  }

  XRayView view;
};

TEST_F(XRayViewTest, TheImageIsSquareAndInTheMiddle)
{
  EXPECT_EQ(view.imageRect(), QRect(0, 100, 600, 600));
  view.resize(900, 500);
  EXPECT_EQ(view.imageRect(), QRect(200, 0, 500, 500));
}

TEST_F(XRayViewTest, MarksStandAtTheirEdges)
{
  const QRect angle(0, 100, 300, 40), left(0, 380, 40, 40), right(560, 380, 40, 40), time(0, 660, 300, 40),
      scale(420, 640, 180, 60);
  for (const QRect& part : {angle, left, right, scale})
    EXPECT_EQ(marked(part), 0);
  XRayMarks marks;
  marks.angle = "LAO 40 CRA 20";
  marks.left = "R";
  marks.right = "L";
  marks.scale = "20 mm";
  marks.bar = 40.0;
  marks.time = "1:15";
  view.showMarks(marks);
  for (const QRect& part : {angle, left, right, time, scale})
    EXPECT_GT(marked(part), 15) << part.x() << ", " << part.y();
}

TEST_F(XRayViewTest, IsBlackWithoutAnImage)
{
  view.showImage({});
  EXPECT_EQ(QColor(view.grab().toImage().pixel(10, 10)), QColor(Qt::black));
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
