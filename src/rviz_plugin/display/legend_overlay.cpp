#include "rviz_plugin/display/legend_overlay.h"

#include <atomic>

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>
#include <QPainter>

#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

// With usual fonts [pixels]
constexpr int kLegendWidth = 92, kLegendHeight = 190;
constexpr int kTitleHeight = 44, kMargin = 7;
constexpr int kBarWidth = 12, kBarTop = 56, kBarHeight = kLegendHeight - kBarTop - 12;
constexpr int kLegendRim = 10, kLegendGap = 8;  // from the edge of the picture, and between two legends [pixels]

std::string uniqueName()
{
  static std::atomic<unsigned> count{0};
  return "endovascular_sim/picture_" + std::to_string(++count);
}

}  // namespace

QImage legendImage(const std::string& title, const visualization::LegendScale& scale,
                   const std::function<visualization::Colour(double)>& colour_at)
{
  const double size = fontScale();
  QImage image(static_cast<int>(size * kLegendWidth), static_cast<int>(size * kLegendHeight), QImage::Format_ARGB32);
  image.fill(QColor(20, 24, 30, 190));
  QPainter painter(&image);
  painter.scale(size, size);
  painter.setRenderHint(QPainter::TextAntialiasing);
  QFont font("DejaVu Sans");
  font.setPixelSize(11);
  painter.setFont(font);
  painter.setPen(Qt::white);
  painter.drawText(QRect(kMargin, 5, kLegendWidth - 2 * kMargin, kTitleHeight), Qt::AlignLeft | Qt::TextWordWrap,
                   QString::fromStdString(title + " [" + scale.unit + "]"));
  const auto height_of = [&](double value)
  { return kBarTop + static_cast<int>((kBarHeight - 1) * (1.0 - value / scale.full)); };
  for (int y = 0; y < kBarHeight; ++y)
  {
    const visualization::Colour colour = colour_at(scale.full * (kBarHeight - 1 - y) / (kBarHeight - 1));
    painter.fillRect(kMargin, kBarTop + y, kBarWidth, 1, QColor::fromRgbF(colour.red, colour.green, colour.blue));
  }
  for (std::size_t k = 0; k < scale.ticks.size(); ++k)
  {
    const int y = height_of(scale.ticks[k]), x = kMargin + kBarWidth;
    painter.drawLine(x, y, x + 4, y);
    painter.drawText(QRect(x + 8, y - 9, kLegendWidth - x - 8, 18), Qt::AlignLeft | Qt::AlignVCenter,
                     QString::fromStdString(scale.labels[k]));
  }
  return image;
}

QPoint legendPlace(int number)
{
  return {kLegendRim, static_cast<int>(kLegendRim + number * fontScale() * (kLegendHeight + kLegendGap))};
}

QSize legendsSize()
{
  return {static_cast<int>(2 * kLegendRim + fontScale() * kLegendWidth), legendPlace(2).y()};
}

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
