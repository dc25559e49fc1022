#pragma once

#include <QImage>
#include <QWidget>

#include "rviz_plugin/picture/x_ray_marks.h"

namespace endovascular_sim::rviz_plugin
{

/** X-ray image with its marks: angle, sides of the patient, scale, fluoroscopy time. */
class XRayView : public QWidget
{
public:
  XRayView();

  void showImage(const QImage& image);
  void showMarks(const XRayMarks& marks);

  /** Square or rectangle of the image in the widget, in its own proportions. */
  QRect imageRect() const;

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  QImage image_;
  XRayMarks marks_;
};

}  // namespace endovascular_sim::rviz_plugin
