#pragma once

#include <string>
#include <vector>

#include <QColor>
#include <QImage>

#include "visualization/name_placement.h"

namespace endovascular_sim::rviz_plugin
{

/** Style of the names in the picture. */
struct NameStyle
{
  QColor colour =
      Qt::white;    ///< of letters and leaders; the ground is dark behind a light colour, and light behind a dark one
  int height = 13;  ///< of the letters [pixels]
};

/** Size of a name with its ground [pixels]. */
Eigen::Vector2d nameSize(const std::string& text, const NameStyle& style);

/** Picture of the names with their leaders, of the size of the view. Every name has a ground of its own and every
 * leader an outline, so that both are readable on any picture. Names whose branch has left the view are
 * not drawn, and the edges of the view cut none. */
QImage namePicture(const std::vector<visualization::PlacedName>& names, const visualization::PictureView& view,
                   const NameStyle& style);

}  // namespace endovascular_sim::rviz_plugin
