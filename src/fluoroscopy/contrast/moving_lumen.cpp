#include "fluoroscopy/contrast/moving_lumen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/wide_vectors.h"
#include "fluoroscopy/contrast/lumen_surface.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kToInteger = 6755399441055744.0;  // 1.5·2⁵²: its last digit is 1, so that a sum is rounded

std::size_t at(int index)
{
  return static_cast<std::size_t>(index);
}

/** Camera of a pose in the order of its use. */
struct Camera
{
  double source[3];
  double right[3], up[3], forward[3];
  double scale, offset;

  explicit Camera(const XRayGeometry& geometry)
    : scale(geometry.focalLength() * static_cast<double>(kSubpixels)),
      offset(geometry.centre() * static_cast<double>(kSubpixels))
  {
    for (int k = 0; k < 3; ++k)
    {
      source[k] = geometry.source()[k];
      right[k] = geometry.axes()(k, 0), up[k] = geometry.axes()(k, 1), forward[k] = geometry.axes()(k, 2);
    }
  }
};

/** Projects points as projectCorner(), which are in front of the source.
 *  @param places column and row of each, alternating [1/4096 pixel] */
EVS_WIDE_VECTORS void projectPoints(const Camera& camera, std::size_t count, const double* x, const double* y,
                                    const double* z, std::int32_t* places, double* inverse_depths)
{
  for (std::size_t k = 0; k < count; ++k)
  {
    const double dx = x[k] - camera.source[0], dy = y[k] - camera.source[1], dz = z[k] - camera.source[2];
    const double inverse = 1.0 / (camera.forward[0] * dx + camera.forward[1] * dy + camera.forward[2] * dz);
    const double along = camera.right[0] * dx + camera.right[1] * dy + camera.right[2] * dz;
    const double across = camera.up[0] * dx + camera.up[1] * dy + camera.up[2] * dz;
    inverse_depths[k] = inverse;
    places[2 * k] =
        static_cast<std::int32_t>((camera.offset + camera.scale * along * inverse + kToInteger) - kToInteger);
    places[2 * k + 1] =
        static_cast<std::int32_t>((camera.offset - camera.scale * across * inverse + kToInteger) - kToInteger);
  }
}

/** True if no integer multiple of a pixel lies between the least and the most of three coordinates. */
bool isBetweenRays(std::int32_t a, std::int32_t b, std::int32_t c)
{
  const std::int32_t least = std::min(std::min(a, b), c), most = std::max(std::max(a, b), c);
  return ((least + static_cast<std::int32_t>(kSubpixels) - 1) >> kSubpixelBits) > (most >> kSubpixelBits);
}

}  // namespace

void MovingLumen::setLumen(std::shared_ptr<const contrast::LumenCells> lumen)
{
  lumen_ = std::move(lumen);
  is_fixed_.clear();
  pose_.reset();
}

void MovingLumen::project(const XRayGeometry& geometry, const MovingVessel& vessel, const std::vector<double>& parts,
                          IodineImage& image)
{
  image.clear();
  divide(vessel);
  projectResting(geometry, vessel);
  placeMoved(geometry, vessel);
  const int pixels = geometry.pixels();
  addFixed(parts);
  selectVisible(parts);
  sweep(pixels, geometry.pose().source_to_detector);
  gather(pixels, image);
}

/** Vertices that move: those of the mesh, and the cuts between them. */
std::vector<char> MovingLumen::movingVertices() const
{
  std::vector<char> moves(lumen_->mesh_vertices + lumen_->cuts.size(), 0);
  for (const int vertex : moving_)
    moves[at(vertex)] = 1;
  for (std::size_t k = 0; k < lumen_->cuts.size(); ++k)
    moves[lumen_->mesh_vertices + k] =
        static_cast<char>(moves[at(lumen_->cuts[k].from)] | moves[at(lumen_->cuts[k].to)]);
  return moves;
}

/** Separates the parts that move from the others. */
void MovingLumen::divide(const MovingVessel& vessel)
{
  if (!is_fixed_.empty() && moving_ == vessel.movingVertices())
    return;
  moving_ = vessel.movingVertices();
  pose_.reset();
  const std::vector<char> moves = movingVertices();
  const auto any = [&moves](const Eigen::Vector3i& t)
  { return (moves[at(t[0])] | moves[at(t[1])] | moves[at(t[2])]) != 0; };
  is_fixed_.assign(lumen_->parts, 1);
  for (const contrast::WallPiece& wall : lumen_->walls)
    if (any(wall.corners) || any(lumen_->triangles[at(wall.triangle)]))
      is_fixed_[at(wall.part)] = 0;
  for (const contrast::LumenCap& cap : lumen_->caps)
    if (any(cap.corners))
      is_fixed_[at(cap.plus)] = is_fixed_[at(cap.minus)] = 0;
  std::vector<char> is_used(moves.size(), 0);
  const auto use = [&is_used](const Eigen::Vector3i& t)
  { is_used[at(t[0])] = is_used[at(t[1])] = is_used[at(t[2])] = 1; };
  for (const contrast::WallPiece& wall : lumen_->walls)
    if (is_fixed_[at(wall.part)] == 0)
      use(wall.corners);
  for (const contrast::LumenCap& cap : lumen_->caps)
    if (is_fixed_[at(cap.plus)] == 0 || is_fixed_[at(cap.minus)] == 0)
      use(cap.corners);
  for (std::size_t k = lumen_->cuts.size(); k-- > 0;)
    if (is_used[lumen_->mesh_vertices + k] != 0)
      is_used[at(lumen_->cuts[k].from)] = is_used[at(lumen_->cuts[k].to)] = 1;
  collectFaces(is_used);
}

/** Lists cuts and faces of the moving parts. */
void MovingLumen::collectFaces(const std::vector<char>& is_used)
{
  std::vector<int> numbers(is_used.size(), -1);
  for (std::size_t k = 0; k < lumen_->mesh_vertices; ++k)
    numbers[k] = static_cast<int>(k);
  cuts_.clear();
  for (std::size_t k = 0; k < lumen_->cuts.size(); ++k)
    if (is_used[lumen_->mesh_vertices + k] != 0)
    {
      const contrast::CutVertex& cut = lumen_->cuts[k];
      numbers[lumen_->mesh_vertices + k] = static_cast<int>(lumen_->mesh_vertices + cuts_.size());
      cuts_.push_back({numbers[at(cut.from)], numbers[at(cut.to)], cut.weight});
    }
  vertices_.clear();
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (is_used[k] != 0)
      vertices_.push_back(numbers[k]);
  faces_.clear();
  runs_.clear();
  std::vector<std::vector<const contrast::WallPiece*>> walls(lumen_->parts);
  for (const contrast::WallPiece& wall : lumen_->walls)
    if (is_fixed_[at(wall.part)] == 0)
      walls[at(wall.part)].push_back(&wall);
  for (const std::vector<const contrast::WallPiece*>& of_part : walls)
    for (const contrast::WallPiece* wall : of_part)
      addFace(wall->corners, wall->corners == lumen_->triangles[at(wall->triangle)] ? -1 : wall->triangle, wall->part,
              -1, numbers);
  for (const contrast::LumenCap& cap : lumen_->caps)
  {
    const int plus = is_fixed_[at(cap.plus)] != 0 ? -1 : cap.plus;
    const int minus = is_fixed_[at(cap.minus)] != 0 ? -1 : cap.minus;
    if (plus != minus)
      addFace(cap.corners, -1, plus, minus, numbers);
  }
}

void MovingLumen::addFace(const Eigen::Vector3i& corners, int triangle, int plus, int minus,
                          const std::vector<int>& numbers)
{
  if (runs_.empty() || runs_.back().plus != plus || runs_.back().minus != minus)
    runs_.push_back({faces_.size(), faces_.size(), plus, minus});
  faces_.push_back({{numbers[at(corners[0])], numbers[at(corners[1])], numbers[at(corners[2])]}, triangle});
  runs_.back().end = faces_.size();
}

void MovingLumen::setPlace(int vertex, const Corner& corner)
{
  places_[at(vertex)] = {static_cast<std::int32_t>(corner.column), static_cast<std::int32_t>(corner.row)};
  inverse_depths_[at(vertex)] = corner.inverse_depth;
}

/** Projects what rests, if the pose has changed. */
void MovingLumen::projectResting(const XRayGeometry& geometry, const MovingVessel& vessel)
{
  if (pose_ && *pose_ == geometry.pose())
    return;
  std::vector<Corner> corners = vessel.corners();
  const std::vector<Eigen::Vector3d> positions = lumen_->place(vessel.positions());
  for (std::size_t k = lumen_->mesh_vertices; k < positions.size(); ++k)
    corners.push_back(projectCorner(geometry, positions[k]));
  fixed_.buildDepths(geometry, *lumen_, corners, is_fixed_);
  places_.resize(lumen_->mesh_vertices + cuts_.size());
  inverse_depths_.resize(places_.size());
  for (std::size_t k = 0; k < lumen_->mesh_vertices; ++k)
    setPlace(static_cast<int>(k), corners[k]);
  const auto pixels = static_cast<std::size_t>(geometry.pixels());
  squares_.resize(pixels);
  for (std::size_t k = 0; k < pixels; ++k)
  {
    const double x = geometry.ray(static_cast<double>(k), 0.0).x();
    squares_[k] = x * x;
  }
  sum_.assign(pixels * pixels, 0.0);
  pose_ = geometry.pose();
}

/** Projects the vertices of the moving parts. */
void MovingLumen::placeMoved(const XRayGeometry& geometry, const MovingVessel& vessel)
{
  for (const int vertex : moving_)
    setPlace(vertex, vessel.corners()[at(vertex)]);
  auto& [x, y, z] = cut_positions_;
  for (std::vector<double>& coordinates : cut_positions_)
    coordinates.resize(cuts_.size());
  const std::size_t first = lumen_->mesh_vertices;
  const std::vector<Eigen::Vector3d>& wall = vessel.positions();
  const auto position = [&](int vertex)
  {
    const std::size_t k = at(vertex);
    return k < first ? wall[k] : Eigen::Vector3d(x[k - first], y[k - first], z[k - first]);
  };
  for (std::size_t k = 0; k < cuts_.size(); ++k)
  {
    const Eigen::Vector3d from = position(cuts_[k].from);
    const Eigen::Vector3d p = from + cuts_[k].weight * (position(cuts_[k].to) - from);
    x[k] = p.x(), y[k] = p.y(), z[k] = p.z();
  }
  projectPoints(Camera(geometry), cuts_.size(), x.data(), y.data(), z.data(), &places_.data()[first].column,
                inverse_depths_.data() + first);
}

void MovingLumen::addFixed(const std::vector<double>& parts)
{
  has_fixed_ = false;
  for (std::size_t p = 0; p < parts.size() && !has_fixed_; ++p)
    has_fixed_ = is_fixed_[p] != 0 && parts[p] != 0.0;
  if (has_fixed_)
    fixed_.forRows(parts, [this](std::uint32_t pixel, double depth) { sum_[pixel] += depth; });
}

/** Lists the faces with different concentrations on their sides whose bounds hold a ray. */
void MovingLumen::selectVisible(const std::vector<double>& parts)
{
  visible_.resize(faces_.size() + 1);
  std::size_t count = 0;
  for (const Run& run : runs_)
  {
    const double inside = run.plus < 0 ? 0.0 : parts[at(run.plus)];
    const double step = inside - (run.minus < 0 ? 0.0 : parts[at(run.minus)]);
    if (step == 0.0)
      continue;
    for (std::size_t k = run.begin; k < run.end; ++k)
    {
      const Place &a = places_[at(faces_[k].corners[0])], &b = places_[at(faces_[k].corners[1])],
                  &c = places_[at(faces_[k].corners[2])];
      visible_[count] = {static_cast<std::uint32_t>(k), step};
      const bool is_between = isBetweenRays(a.row, b.row, c.row) | isBetweenRays(a.column, b.column, c.column);
      count += is_between ? 0 : 1;
    }
  }
  visible_.resize(count);
}

/** Pixels in front of the moving parts; all, if others hold iodine. */
MovingLumen::Box MovingLumen::boxOf(int pixels) const
{
  if (has_fixed_)
    return {0, pixels - 1, 0, pixels - 1};
  Place least{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max()};
  Place most{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min()};
  for (const int vertex : vertices_)
  {
    const Place& place = places_[at(vertex)];
    least = {std::min(least.column, place.column), std::min(least.row, place.row)};
    most = {std::max(most.column, place.column), std::max(most.row, place.row)};
  }
  return {firstPixel(least.row), lastPixel(most.row, pixels), firstPixel(least.column), lastPixel(most.column, pixels)};
}

void MovingLumen::sweep(int pixels, double detector_depth)
{
  for (const Visible& visible : visible_)
  {
    const Face& face = faces_[visible.face];
    const Corner a = cornerOf(face.corners[0]), b = cornerOf(face.corners[1]), c = cornerOf(face.corners[2]);
    const auto add = [this, pixels, detector_depth, concentration = visible.concentration](
                         int row, int column, double inverse_depth, double sign) {
      sum_[at(row) * at(pixels) + at(column)] += concentration * sign * std::min(1.0 / inverse_depth, detector_depth);
    };
    if (face.triangle < 0)
    {
      coveredPixels(a, b, c, pixels, add);
      continue;
    }
    const Eigen::Vector3i& whole = lumen_->triangles[at(face.triangle)];
    coveredByPiece(a, b, c, DepthPlane(cornerOf(whole[0]), cornerOf(whole[1]), cornerOf(whole[2])), pixels, add);
  }
}

/** Lists the pixels with iodine, and empties the sum. */
void MovingLumen::gather(int pixels, IodineImage& image)
{
  const Box box = boxOf(pixels);
  for (int row = box.first_row; row <= box.last_row; ++row)
    for (int column = box.first_column; column <= box.last_column; ++column)
    {
      const std::size_t k = at(row) * at(pixels) + at(column);
      if (sum_[k] == 0.0)
        continue;
      if (sum_[k] > 0.0)
        image.add(k, sum_[k] * std::sqrt(squares_[at(column)] + squares_[at(row)] + 1.0));
      sum_[k] = 0.0;
    }
}

}  // namespace endovascular_sim::fluoroscopy
