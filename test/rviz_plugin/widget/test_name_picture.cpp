#include "rviz_plugin/widget/name_picture.h"

#include <gtest/gtest.h>
#include <QApplication>
#include <QPainter>

#include "test/rviz_plugin/widget/widget_test.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

class NamePictureTest : public WidgetTest
{
protected:
  NamePictureTest()
  {
    view.eye = {0.0, -1.0, 0.0};
    view.width = 300.0;
    view.height = 200.0;
    names.push_back({"left main", nameSize("left main", style), Eigen::Vector3d::Zero(), {80.0, 40.0}});
  }

  /** Picture of the names over a ground of one colour. */
  QImage over(const QColor& ground) const
  {
    QImage image(300, 200, QImage::Format_RGB32);
    image.fill(ground);
    QPainter(&image).drawImage(0, 0, namePicture(names, view, style));
    return image;
  }

  NameStyle style;
  visualization::PictureView view;
  std::vector<visualization::PlacedName> names;
};

TEST_F(NamePictureTest, LettersStandOutFromTheirGroundOnLightAndDarkPictures)
{
  for (const QColor& colour : {QColor(245, 245, 245), QColor(20, 20, 20)})
    for (const QColor& ground : {QColor(Qt::white), QColor(38, 43, 52), QColor(226, 120, 110)})
    {
      style.colour = colour;
      const QImage image = over(ground);
      const visualization::Rectangle box = names[0].box(view);
      int lightest = 0, darkest = 255;
      for (int x = static_cast<int>(150 + box.low.x()) + 3; x < static_cast<int>(150 + box.high.x()) - 3; ++x)
        for (int y = static_cast<int>(100 - box.high.y()) + 3; y < static_cast<int>(100 - box.low.y()) - 3; ++y)
        {
          const int lightness = QColor(image.pixel(x, y)).lightness();
          lightest = std::max(lightest, lightness);
          darkest = std::min(darkest, lightness);
        }
      EXPECT_GT(lightest - darkest, 150) << colour.name().toStdString() << " on " << ground.name().toStdString();
    }
}

TEST_F(NamePictureTest, LeadersStandOutOnLightAndDarkPictures)
{
  for (const QColor& ground : {QColor(Qt::white), QColor(38, 43, 52)})
  {
    const QImage image = over(ground);
    int lightest = 0, darkest = 255;
    for (int x = 140; x < 160; ++x)
      for (int y = 90; y < 110; ++y)
      {
        const int lightness = QColor(image.pixel(x, y)).lightness();
        lightest = std::max(lightest, lightness);
        darkest = std::min(darkest, lightness);
      }
    EXPECT_GT(lightest - darkest, 120) << ground.name().toStdString();
  }
}

TEST_F(NamePictureTest, NamesOutsideOfTheViewAreNotDrawn)
{
  names[0].end = {1.0, 0.0, 0.0};
  names.push_back(names[0]);
  names[1].end = {0.0, -2.0, 0.0};  // behind the eye
  const QImage image = over(Qt::white);
  for (int x = 0; x < image.width(); ++x)
    for (int y = 0; y < image.height(); ++y)
      ASSERT_EQ(QColor(image.pixel(x, y)), QColor(Qt::white));
}

TEST_F(NamePictureTest, TheEdgeOfTheViewCutsNoName)
{
  names[0].offset = {140.0, 40.0};
  const visualization::Rectangle box = names[0].box(view);
  ASSERT_GT(box.high.x(), 150.0);
  const QImage image = over(Qt::white);
  const int left = 300 - static_cast<int>(names[0].size.x());
  EXPECT_NE(QColor(image.pixel(left + 1, 60)), QColor(Qt::white)) << "the ground of the whole name is in the view";
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
