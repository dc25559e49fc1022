#pragma once

#include <functional>
#include <string>

#include <OgreMaterial.h>
#include <OgreTexture.h>
#include <QImage>
#include <QPoint>
#include <QSize>

#include "visualization/colour_legend.h"

namespace Ogre
{
class Overlay;
class OverlayContainer;
}  // namespace Ogre

namespace endovascular_sim::rviz_plugin
{

/** Picture of a legend: a title, a bar of colours, ticks with labels. Its size follows fontScale().
 *  @param colour_at colour of a value */
QImage legendImage(const std::string& title, const visualization::LegendScale& scale,
                   const std::function<visualization::Colour(double)>& colour_at);

/** Place of a legend: margins from the lower left corner [pixels]. @param number of the legend, from below: 0 or 1
 */
QPoint legendPlace(int number);

/** Size of both legends with their rim, in the lower left corner [pixels]. */
QSize legendsSize();

/** Picture over the scene, in a fixed place from the lower left corner. */
class PictureOverlay
{
public:
  PictureOverlay();
  ~PictureOverlay();
  PictureOverlay(const PictureOverlay&) = delete;
  PictureOverlay& operator=(const PictureOverlay&) = delete;

  /** @param place margins from the left and the lower edge [pixels] */
  void show(const QImage& image, const QPoint& place);
  void hide();

private:
  void resize(int width, int height);

  std::string name_;
  Ogre::Overlay* overlay_;
  Ogre::OverlayContainer* panel_;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr texture_;
};

}  // namespace endovascular_sim::rviz_plugin
