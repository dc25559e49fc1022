#include "rviz_plugin/display/surface_object.h"

#include <atomic>
#include <cstring>

#include <OgreMaterialManager.h>
#include <OgreResourceGroupManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** Unique among all plugins of the process. */
std::string uniqueName()
{
  static std::atomic<unsigned> count{0};
  return "endovascular_sim/surface_" + std::to_string(++count);
}

Ogre::MaterialPtr makeMaterial(DrawingOrder order, DrawnFaces faces)
{
  // "rviz" is no resource group of every version of rviz: Ogre's own group always exists.
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(
      uniqueName(), Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  material->setReceiveShadows(false);
  Ogre::Technique* technique = material->getTechnique(0);
  Ogre::Pass* pass = technique->getPass(0);
  if (order == DrawingOrder::kFarWall)
  {
    // Depth first: of several walls behind each other only the nearest one is drawn, in whatever order its triangles
    // come.
    pass->setColourWriteEnabled(false);
    pass->setLightingEnabled(false);
    pass->setCullingMode(Ogre::CULL_CLOCKWISE);
    pass = technique->createPass();
  }
  pass->setLightingEnabled(true);
  pass->setVertexColourTracking(Ogre::TVC_AMBIENT | Ogre::TVC_DIFFUSE);
  const float specular = order == DrawingOrder::kOpaque || order == DrawingOrder::kInside ? 0.5F : 0.15F;
  pass->setSpecular(specular, specular, specular, 1.0F);
  pass->setShininess(40.0F);
  // Back faces are drawn as front faces of the reversed surface (SurfaceObject::update()).
  pass->setCullingMode(faces == DrawnFaces::kBoth ? Ogre::CULL_NONE : Ogre::CULL_CLOCKWISE);
  if (order != DrawingOrder::kOpaque)
  {
    pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
    pass->setDepthWriteEnabled(order == DrawingOrder::kInside);
  }
  return material;
}

}  // namespace

SurfaceObject::SurfaceObject(Ogre::SceneManager* manager, Ogre::SceneNode* parent, DrawingOrder order, DrawnFaces faces)
  : manager_(manager), faces_(faces), material_(makeMaterial(order, faces)), object_(manager->createManualObject())
{
  object_->setDynamic(true);
  object_->setRenderQueueGroup(static_cast<Ogre::uint8>(Ogre::RENDER_QUEUE_MAIN + static_cast<int>(order)));
  parent->attachObject(object_);
}

SurfaceObject::~SurfaceObject()
{
  manager_->destroyManualObject(object_);
  Ogre::MaterialManager::getSingleton().remove(material_);
}

void SurfaceObject::update(const visualization::Surface& surface, const std::vector<std::uint32_t>& triangles)
{
  vertices_.content.clear();
  if (triangles.empty())
  {
    object_->setVisible(false);
    return;
  }
  const bool needs_wide_indices = surface.positions.size() > 65535;
  if (needs_wide_indices != has_wide_indices_)
    object_->clear();  // buffers of the other type cannot be reused
  has_wide_indices_ = needs_wide_indices;
  object_->estimateVertexCount(surface.positions.size());
  object_->estimateIndexCount(triangles.size());
  if (object_->getSections().empty())
    object_->begin(material_->getName(), Ogre::RenderOperation::OT_TRIANGLE_LIST,
                   Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  else
    object_->beginUpdate(0);
  const bool is_reversed = faces_ == DrawnFaces::kBack;
  const float side = is_reversed ? -1.0F : 1.0F;
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
  {
    const Eigen::Vector3f& position = surface.positions[i];
    const Eigen::Vector3f normal = side * surface.normals[i];
    const visualization::TranslucentColour& colour = surface.colours[i];
    object_->position(position.x(), position.y(), position.z());
    object_->normal(normal.x(), normal.y(), normal.z());
    object_->colour(colour.colour.red, colour.colour.green, colour.colour.blue, colour.opacity);
  }
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
  {
    if (is_reversed)
      object_->triangle(triangles[i], triangles[i + 2], triangles[i + 1]);
    else
      object_->triangle(triangles[i], triangles[i + 1], triangles[i + 2]);
  }
  object_->end();
  object_->setVisible(true);
}

void SurfaceObject::Vertices::setPosition(std::size_t vertex, const Eigen::Vector3f& position)
{
  static_assert(sizeof(float) == sizeof(Ogre::Real), "Ogre's positions are floats");
  std::memcpy(content.data() + vertex * size + offset, position.data(), 3 * sizeof(float));
}

/** @return false if the object does not draw as many vertices */
bool SurfaceObject::readVertices(std::size_t count)
{
  if (object_->getSections().empty() || !object_->getVisible())
    return false;
  if (!vertices_.content.empty())
    return vertices_.content.size() >= count * vertices_.size;
  const Ogre::VertexData* data = object_->getSections().front()->getRenderOperation()->vertexData;
  const Ogre::VertexElement* position = data->vertexDeclaration->findElementBySemantic(Ogre::VES_POSITION);
  if (position == nullptr || data->vertexCount < count)
    return false;
  vertices_.buffer = data->vertexBufferBinding->getBuffer(position->getSource());
  vertices_.offset = position->getOffset();
  vertices_.size = vertices_.buffer->getVertexSize();
  vertices_.content.resize(data->vertexCount * vertices_.size);
  vertices_.buffer->readData(0, vertices_.content.size(), vertices_.content.data());
  return true;
}

void SurfaceObject::writeVertices()
{
  vertices_.buffer->writeData(0, vertices_.content.size(), vertices_.content.data(), true);
}

void SurfaceObject::move(const visualization::Surface& surface, const std::vector<std::uint32_t>& vertices)
{
  if (vertices.empty() || !readVertices(surface.positions.size()))
    return;
  for (const std::uint32_t vertex : vertices)
    vertices_.setPosition(vertex, surface.positions[vertex]);
  writeVertices();
}

void SurfaceObject::move(const visualization::Surface& surface)
{
  if (surface.positions.empty() || !readVertices(surface.positions.size()))
    return;
  for (std::size_t vertex = 0; vertex < surface.positions.size(); ++vertex)
    vertices_.setPosition(vertex, surface.positions[vertex]);
  writeVertices();
}

void SurfaceObject::setGlow(const visualization::Colour& colour)
{
  Ogre::Technique* technique = material_->getTechnique(0);
  technique->getPass(static_cast<unsigned short>(technique->getNumPasses() - 1))
      ->setSelfIllumination(colour.red, colour.green, colour.blue);
}

void SurfaceObject::setFlat()
{
  Ogre::Pass* pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setDepthWriteEnabled(false);
}

void SurfaceObject::setVisible(bool visible)
{
  object_->setVisible(visible && !object_->getSections().empty());
}

void SurfaceObject::clear()
{
  object_->clear();
  vertices_ = {};
}

}  // namespace endovascular_sim::rviz_plugin
