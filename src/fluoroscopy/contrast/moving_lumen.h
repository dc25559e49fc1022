#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "contrast/lumen/lumen_cells.h"
#include "fluoroscopy/contrast/iodine_image.h"
#include "fluoroscopy/contrast/lumen_matrix.h"
#include "fluoroscopy/projection/moving_vessel.h"
#include "fluoroscopy/projection/signed_depth.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Iodine along the rays through a lumen that moves with the heart, for a sequence of frames.
 *
 *  On walls and caps of the parts that move, the depths are summed in every frame, with the concentration behind them:
 * c of a wall's part, c₊ − c₋ of a cap. Their lengths would be needed once only. Faces between equal concentrations,
 * as those without iodine, are left out, and those that lie between the rays are sorted out by their bounds. The parts
 * without a moving vertex are a LumenMatrix, which is kept while the pose rests. */
class MovingLumen
{
public:
  /** Replaces the parts; null: none. */
  void setLumen(std::shared_ptr<const contrast::LumenCells> lumen);

  /** The wall at rest has changed. */
  void reset() { pose_.reset(); }

  /** Computes the iodine along the rays. @pre the lumen fits the vessel's mesh, and the vessel moves
   *  @param vessel projected with this geometry
   *  @param parts concentrations [kg/m³] */
  void project(const XRayGeometry& geometry, const MovingVessel& vessel, const std::vector<double>& parts,
               IodineImage& image);

private:
  /** Vertex in the image [1/4096 pixel]; compact, because most faces need no more. */
  struct Place
  {
    std::int32_t column = 0, row = 0;
  };

  /** Cut vertex of a part that moves, numbered behind the vertices of the mesh. */
  struct Cut
  {
    int from, to;
    double weight;
  };

  struct Face
  {
    std::array<int, 3> corners;
    int triangle;  ///< of the mesh, if a plane cuts it; else −1
  };

  /** Faces with the same parts on their sides. */
  struct Run
  {
    std::size_t begin, end;
    int plus, minus;  ///< parts; −1: outside, or a part that rests
  };

  /** Face in front of a ray. */
  struct Visible
  {
    std::uint32_t face;
    double concentration;  ///< on its inner side, minus that on its outer side [kg/m³]
  };

  /** Pixels among which depths are summed. */
  struct Box
  {
    int first_row, last_row, first_column, last_column;
  };

  void divide(const MovingVessel& vessel);
  std::vector<char> movingVertices() const;
  void collectFaces(const std::vector<char>& is_used);
  void addFace(const Eigen::Vector3i& corners, int triangle, int plus, int minus, const std::vector<int>& numbers);
  void projectResting(const XRayGeometry& geometry, const MovingVessel& vessel);
  void placeMoved(const XRayGeometry& geometry, const MovingVessel& vessel);
  void setPlace(int vertex, const Corner& corner);
  Corner cornerOf(int vertex) const
  {
    const auto k = static_cast<std::size_t>(vertex);
    return {places_[k].column, places_[k].row, inverse_depths_[k]};
  }
  Box boxOf(int pixels) const;
  void addFixed(const std::vector<double>& parts);
  void selectVisible(const std::vector<double>& parts);
  void sweep(int pixels, double detector_depth);
  void gather(int pixels, IodineImage& image);

  std::shared_ptr<const contrast::LumenCells> lumen_;
  std::vector<int> moving_;       ///< vertices of the mesh that move, for which the lists below hold
  std::vector<char> is_fixed_;    ///< for each part: none of its vertices moves
  std::vector<Cut> cuts_;         ///< of the moving parts
  std::vector<Face> faces_;       ///< of the moving parts
  std::vector<int> vertices_;     ///< of faces_
  std::vector<Run> runs_;         ///< of faces_
  std::optional<CArmPose> pose_;  ///< of what follows
  LumenMatrix fixed_;
  std::vector<double> squares_;                       ///< (x/z)² of each column's rays, or (y/z)² of each row's [1]
  std::vector<Place> places_;                         ///< of the mesh's vertices and cuts_
  std::vector<double> inverse_depths_;                ///< of the same [1/m]
  std::array<std::vector<double>, 3> cut_positions_;  ///< of cuts_, moved [m]
  std::vector<Visible> visible_;
  bool has_fixed_ = false;   ///< iodine in a part that rests
  std::vector<double> sum_;  ///< depths weighted with concentrations; zero between two frames [kg/m²]
};

}  // namespace endovascular_sim::fluoroscopy
