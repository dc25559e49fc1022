#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <OgreHardwareVertexBuffer.h>
#include <OgreManualObject.h>
#include <OgreMaterial.h>
#include <OgreSceneManager.h>

#include "visualization/tube_surface.h"

namespace endovascular_sim::rviz_plugin
{

/** Order in which translucent surfaces are drawn: after the opaque ones, from the far wall to the near one. */
enum class DrawingOrder
{
  kOpaque,
  kFarWall,   ///< back faces of the wall
  kInside,    ///< translucent bodies in the vessel, and the heat map
  kNearWall,  ///< front faces of the wall
};

/** Drawn faces of a surface. */
enum class DrawnFaces
{
  kFront,
  kBack,  ///< lit from their own side
  kBoth,
};

/** Surface in the scene of Ogre. */
class SurfaceObject
{
public:
  /** @param parent node to which the surface is attached; it and the scene manager outlive this */
  SurfaceObject(Ogre::SceneManager* manager, Ogre::SceneNode* parent, DrawingOrder order, DrawnFaces faces);
  ~SurfaceObject();
  SurfaceObject(const SurfaceObject&) = delete;
  SurfaceObject& operator=(const SurfaceObject&) = delete;

  /** Replaces vertices and triangles. Buffers of the graphics processor are reused.
   *  @param triangles vertices of the surface, three per triangle */
  void update(const visualization::Surface& surface, const std::vector<std::uint32_t>& triangles);
  /** Moves vertices of the surface of the last update(); all else remains. The buffer is written at once.
   *  @param vertices that have moved */
  void move(const visualization::Surface& surface, const std::vector<std::uint32_t>& vertices);
  /** Moves all vertices. */
  void move(const visualization::Surface& surface);
  /** Light of the surface's own, for walls that are seen at a grazing angle. */
  void setGlow(const visualization::Colour& colour);
  /** Colours without light, as in a legend; the surface hides nothing behind it. For a heat map. */
  void setFlat();
  void setVisible(bool visible);
  void clear();

private:
  /** Buffer of the vertices, and a copy of its content for move(). */
  struct Vertices
  {
    Ogre::HardwareVertexBufferSharedPtr buffer;
    std::vector<unsigned char> content;  ///< empty: not read since the last update()
    std::size_t offset = 0;              ///< of a position in its vertex [bytes]
    std::size_t size = 0;                ///< of a vertex [bytes]
    void setPosition(std::size_t vertex, const Eigen::Vector3f& position);
  };
  bool readVertices(std::size_t count);
  void writeVertices();

  Ogre::SceneManager* manager_;
  DrawnFaces faces_;
  Ogre::MaterialPtr material_;
  Ogre::ManualObject* object_;
  bool has_wide_indices_ = false;
  Vertices vertices_;
};

}  // namespace endovascular_sim::rviz_plugin
