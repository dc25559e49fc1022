#include "rviz_plugin/display/legend_overlay.h"

#include <atomic>

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

std::string uniqueName()
{
  static std::atomic<unsigned> count{0};
  return "endovascular_sim/picture_" + std::to_string(++count);
}

}  // namespace

PictureOverlay::PictureOverlay() : name_(uniqueName())
{
  Ogre::OverlayManager& manager = Ogre::OverlayManager::getSingleton();
  overlay_ = manager.create(name_);
  panel_ = static_cast<Ogre::OverlayContainer*>(manager.createOverlayElement("Panel", name_ + "_panel"));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  material_ = Ogre::MaterialManager::getSingleton().create(name_ + "_material",
                                                           Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  Ogre::Pass* pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  panel_->setMaterialName(material_->getName(), material_->getGroup());
  overlay_->add2D(panel_);
}

PictureOverlay::~PictureOverlay()
{
  Ogre::OverlayManager& manager = Ogre::OverlayManager::getSingleton();
  overlay_->hide();
  overlay_->remove2D(panel_);
  manager.destroyOverlayElement(panel_);
  manager.destroy(overlay_);
  Ogre::MaterialManager::getSingleton().remove(material_);
  if (texture_)
    Ogre::TextureManager::getSingleton().remove(texture_);
}

void PictureOverlay::show(const QImage& image, const QPoint& place)
{
  const QImage pixels = image.convertToFormat(QImage::Format_ARGB32);
  resize(pixels.width(), pixels.height());
  panel_->setPosition(static_cast<float>(place.x()), static_cast<float>(-place.y() - pixels.height()));
  panel_->setDimensions(static_cast<float>(pixels.width()), static_cast<float>(pixels.height()));
  const Ogre::PixelBox source(static_cast<Ogre::uint32>(pixels.width()), static_cast<Ogre::uint32>(pixels.height()), 1,
                              Ogre::PF_A8R8G8B8, const_cast<uchar*>(pixels.constBits()));
  texture_->getBuffer()->blitFromMemory(source);
  overlay_->show();
}

void PictureOverlay::hide()
{
  overlay_->hide();
}

void PictureOverlay::resize(int width, int height)
{
  const auto columns = static_cast<Ogre::uint32>(width), rows = static_cast<Ogre::uint32>(height);
  if (texture_ && texture_->getWidth() == columns && texture_->getHeight() == rows)
    return;
  Ogre::Pass* pass = material_->getTechnique(0)->getPass(0);
  pass->removeAllTextureUnitStates();
  if (texture_)
    Ogre::TextureManager::getSingleton().remove(texture_);
  texture_ = Ogre::TextureManager::getSingleton().createManual(uniqueName(),
                                                               Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME,
                                                               Ogre::TEX_TYPE_2D, columns, rows, 0, Ogre::PF_A8R8G8B8);
  pass->createTextureUnitState(texture_->getName());
}

}  // namespace endovascular_sim::rviz_plugin
