#pragma once

#include <string>

#include <OgreMaterial.h>
#include <OgreTexture.h>
#include <QImage>
#include <QPoint>

namespace Ogre
{
class Overlay;
class OverlayContainer;
}  // namespace Ogre

namespace endovascular_sim::rviz_plugin
{

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
