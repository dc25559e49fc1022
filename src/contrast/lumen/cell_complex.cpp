#include "contrast/lumen/cell_complex.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace endovascular_sim::contrast
{
namespace
{

std::size_t at(int index)
{
  return static_cast<std::size_t>(index);
}

bool holds(const Eigen::Vector3i& corners, int vertex)
{
  return corners[0] == vertex || corners[1] == vertex || corners[2] == vertex;
}

/** Face that a plane crosses: the edges on which its outline passes to the front and to the back. */
struct CrossedFace
{
  Section::Crossing forth, back;
  bool taken = false;
};

bool sameEdge(const Section::Crossing& a, const Section::Crossing& b)
{
  return a.behind == b.behind && a.before == b.before;
}

bool precedes(const Section::Crossing& a, const Section::Crossing& b)
{
  return a.behind != b.behind ? a.behind < b.behind : a.before < b.before;
}

/** Curve of crossed faces that begins with one of them; empty if it does not close. @param faces sorted by `back` */
std::vector<Section::Crossing> follow(std::vector<CrossedFace>& faces, std::size_t first)
{
  std::vector<Section::Crossing> curve;
  std::size_t k = first;
  do
  {
    faces[k].taken = true;
    curve.push_back(faces[k].forth);
    const auto next = std::lower_bound(faces.begin(), faces.end(), faces[k].forth,
                                       [](const CrossedFace& face, const Section::Crossing& edge)
                                       { return precedes(face.back, edge); });
    if (next == faces.end() || !sameEdge(next->back, faces[k].forth))
      return {};
    k = static_cast<std::size_t>(next - faces.begin());
  } while (!faces[k].taken);
  return k == first ? curve : std::vector<Section::Crossing>{};
}

/** Area and winding number of a polygon about a point of its plane, and its largest distance from there. */
struct Outline
{
  double area = 0.0;
  int winding = 0;
  double reach = 0.0;
};

Outline outlineOf(const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& normal)
{
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  Outline outline;
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Eigen::Vector3d a = polygon[k] - point, b = polygon[(k + 1) % polygon.size()] - point;
    const double ax = u.dot(a), ay = v.dot(a), bx = u.dot(b), by = v.dot(b);
    const double cross = ax * by - ay * bx;
    outline.area += 0.5 * cross;
    outline.reach = std::max(outline.reach, a.norm());
    if (ay < 0.0 && by >= 0.0 && cross > 0.0)
      ++outline.winding;
    else if (ay >= 0.0 && by < 0.0 && cross < 0.0)
      --outline.winding;
  }
  return outline;
}

}  // namespace

bool Section::surrounds(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const
{
  return outlineOf(rim, point, normal).winding != 0;
}

CellComplex::CellComplex(const geometry::TriangleMesh& mesh)
  : positions_(mesh.vertices),
    mesh_vertices_(mesh.vertices.size()),
    faces_of_region_(1),
    faces_at_vertex_(mesh_vertices_)
{
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    append({mesh.triangles[k], 0, -1, static_cast<int>(k)});
}

void CellComplex::append(const Face& face)
{
  const int index = static_cast<int>(faces_.size());
  faces_.push_back(face);
  mark_.push_back(0);
  for (int k = 0; k < 3; ++k)
    faces_at_vertex_[at(face.corners[k])].push_back(index);
  faces_of_region_[at(face.plus)].push_back(index);
  if (face.minus >= 0)
    faces_of_region_[at(face.minus)].push_back(index);
}

bool CellComplex::touches(int face, int region) const
{
  return faces_[at(face)].plus == region || faces_[at(face)].minus == region;
}

/** Corners of a face, counter-clockwise seen from outside of a region. */
Eigen::Vector3i CellComplex::outward(int face, int region) const
{
  const Face& f = faces_[at(face)];
  return f.plus == region ? f.corners : Eigen::Vector3i(f.corners[0], f.corners[2], f.corners[1]);
}

void CellComplex::compact(int region)
{
  std::vector<int>& list = faces_of_region_[at(region)];
  list.erase(std::remove_if(list.begin(), list.end(), [&](int face) { return !touches(face, region); }), list.end());
}

std::optional<Section> CellComplex::section(int region, const CutPlane& plane)
{
  compact(region);
  const double offset = plane.normal.dot(plane.point);
  std::vector<CrossedFace> crossed;
  for (const int face : faces_of_region_[at(region)])
  {
    const Eigen::Vector3i corners = outward(face, region);
    std::array<bool, 3> before{};
    for (int k = 0; k < 3; ++k)
      before[at(k)] = plane.normal.dot(positions_[at(corners[k])]) >= offset;
    if (before[0] == before[1] && before[1] == before[2])
      continue;
    CrossedFace item;
    for (int k = 0; k < 3; ++k)
    {
      const int a = corners[k], b = corners[(k + 1) % 3];
      if (!before[at(k)] && before[at((k + 1) % 3)])
        item.forth = {a, b};
      else if (before[at(k)] && !before[at((k + 1) % 3)])
        item.back = {b, a};
    }
    crossed.push_back(item);
  }
  std::sort(crossed.begin(), crossed.end(),
            [](const CrossedFace& a, const CrossedFace& b) { return precedes(a.back, b.back); });
  std::optional<Section> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < crossed.size(); ++k)
  {
    if (crossed[k].taken)
      continue;
    Section found;
    found.crossings = follow(crossed, k);
    if (found.crossings.size() < 3)
      continue;
    for (const Section::Crossing& edge : found.crossings)
    {
      const Eigen::Vector3d& a = positions_[at(edge.behind)];
      const Eigen::Vector3d& b = positions_[at(edge.before)];
      const double height = plane.normal.dot(a) - offset;
      found.rim.emplace_back(a + height / (height - (plane.normal.dot(b) - offset)) * (b - a));
    }
    const Outline outline = outlineOf(found.rim, plane.point, plane.normal);
    if (outline.winding != 1 || outline.area >= least)
      continue;
    least = outline.area;
    found.reach = outline.reach;
    best = std::move(found);
  }
  return best;
}

bool CellComplex::isBefore(const Split& a, const Split& b)
{
  return a.low != b.low ? a.low < b.low : a.high < b.high;
}

int CellComplex::regionAt(int vertex) const
{
  for (const int face : faces_at_vertex_[at(vertex)])
    if (faces_[at(face)].minus < 0 && holds(faces_[at(face)].corners, vertex))
      return faces_[at(face)].plus;
  return 0;
}

int CellComplex::addVertex(const Section::Crossing& crossing, const CutPlane& plane)
{
  const Eigen::Vector3d& a = positions_[at(crossing.behind)];
  const Eigen::Vector3d& b = positions_[at(crossing.before)];
  const double behind = plane.normal.dot(a - plane.point), before = plane.normal.dot(b - plane.point);
  const double weight = behind < 0.0 && before > behind ? std::clamp(behind / (behind - before), 0.0, 1.0) : 0.0;
  cuts_.push_back({crossing.behind, crossing.before, weight});
  const Eigen::Vector3d position = a + weight * (b - a);
  positions_.push_back(position);
  faces_at_vertex_.emplace_back();
  return static_cast<int>(positions_.size()) - 1;
}

/** @param ring new vertices in the order of the section */
std::vector<CellComplex::Split> CellComplex::splitEdges(const Section& section, const CutPlane& plane,
                                                        std::vector<int>& ring)
{
  std::vector<Split> splits;
  for (const Section::Crossing& edge : section.crossings)
  {
    ring.push_back(addVertex(edge, plane));
    splits.push_back({std::min(edge.behind, edge.before), std::max(edge.behind, edge.before), ring.back()});
  }
  std::sort(splits.begin(), splits.end(), isBefore);
  return splits;
}

/** Replaces a face by the parts between the new vertices on its edges. */
void CellComplex::splitFace(int face, const std::vector<Split>& splits)
{
  const Face old = faces_[at(face)];
  std::array<int, 3> middle{-1, -1, -1};  // new vertex on the edge from corner k to the next one
  int count = 0, split = 0, whole = 0;    // the last edges of each kind
  for (int k = 0; k < 3; ++k)
  {
    const int a = old.corners[k], b = old.corners[(k + 1) % 3];
    const Split key{std::min(a, b), std::max(a, b), 0};
    const auto found = std::lower_bound(splits.begin(), splits.end(), key, isBefore);
    const bool is_split = found != splits.end() && found->low == key.low && found->high == key.high;
    middle[at(k)] = is_split ? found->vertex : -1;
    count += is_split ? 1 : 0;
    (is_split ? split : whole) = k;
  }
  const auto corner = [&old](int k) { return old.corners[k % 3]; };
  const auto on = [&middle](int k) { return middle[at(k % 3)]; };
  std::vector<Eigen::Vector3i> parts;
  if (count == 1)
    parts = {{corner(split), on(split), corner(split + 2)}, {on(split), corner(split + 1), corner(split + 2)}};
  else if (count == 2)
    parts = {{on(whole + 1), corner(whole + 2), on(whole + 2)},
             {corner(whole), corner(whole + 1), on(whole + 1)},
             {corner(whole), on(whole + 1), on(whole + 2)}};
  else if (count == 3)
    parts = {{corner(0), on(0), on(2)}, {corner(1), on(1), on(0)}, {corner(2), on(2), on(1)}, {on(0), on(1), on(2)}};
  else
    return;
  faces_[at(face)].corners = parts.front();
  for (int k = 0; k < 3; ++k)
    if (!holds(old.corners, parts.front()[k]))
      faces_at_vertex_[at(parts.front()[k])].push_back(face);
  for (std::size_t k = 1; k < parts.size(); ++k)
    append({parts[k], old.plus, old.minus, old.triangle});
}

int CellComplex::neighbour(int face, int region, int a, int b) const
{
  const std::vector<int>& list = faces_at_vertex_[at(a)].size() < faces_at_vertex_[at(b)].size()
                                     ? faces_at_vertex_[at(a)]
                                     : faces_at_vertex_[at(b)];
  for (const int other : list)
    if (other != face && touches(other, region) && holds(faces_[at(other)].corners, a) &&
        holds(faces_[at(other)].corners, b))
      return other;
  return -1;
}

/** True if a section crosses a ring that waits. */
bool CellComplex::crossesRing(const Section& section) const
{
  std::vector<std::pair<int, int>> edges;
  for (const Section::Crossing& crossing : section.crossings)
    edges.push_back(std::minmax(crossing.behind, crossing.before));
  std::sort(edges.begin(), edges.end());
  for (const Ring& ring : rings_)
    for (std::size_t k = 0; k < ring.vertices.size(); ++k)
    {
      const std::pair<int, int> edge = std::minmax(ring.vertices[k], ring.vertices[(k + 1) % ring.vertices.size()]);
      if (std::binary_search(edges.begin(), edges.end(), edge))
        return true;
    }
  return false;
}

/** Edges of a ring and of those that wait on a region: ascending pairs of vertices. */
std::vector<std::pair<int, int>> CellComplex::barriersOf(int region, const std::vector<int>& ring) const
{
  std::vector<std::pair<int, int>> edges;
  const auto add = [&edges](const std::vector<int>& vertices)
  {
    for (std::size_t k = 0; k < vertices.size(); ++k)
      edges.push_back(std::minmax(vertices[k], vertices[(k + 1) % vertices.size()]));
  };
  add(ring);
  for (const Ring& waiting : rings_)
    if (waiting.region == region)
      add(waiting.vertices);
  std::sort(edges.begin(), edges.end());
  return edges;
}

/** Region that lies before the edge of a ring, of those on both sides of a new cut. */
int CellComplex::regionBefore(int a, int b, const Sides& sides) const
{
  for (const int face : faces_at_vertex_[at(b)])
    for (const int region : {sides.behind, sides.before})
    {
      if (!touches(face, region))
        continue;
      const Eigen::Vector3i corners = outward(face, region);
      for (int c = 0; c < 3; ++c)
        if (corners[c] == a && corners[(c + 1) % 3] == b)
          return region;
    }
  return -1;
}

/** Makes caps of the rings that now lie between different regions. @param region that was divided */
void CellComplex::capRings(int region, const Sides& sides)
{
  std::vector<Ring> waiting;
  for (Ring& ring : rings_)
  {
    if (ring.region == region)
    {
      const int a = ring.vertices[0], b = ring.vertices[1];
      const Sides own{regionBefore(b, a, sides), regionBefore(a, b, sides)};
      if (own.behind != own.before)
      {
        addCaps(ring.vertices, 0, ring.vertices.size() - 1, own);
        continue;
      }
      ring.region = own.before;
    }
    waiting.push_back(std::move(ring));
  }
  rings_ = std::move(waiting);
}

/** Finds the parts of a region's surface on both sides of a ring of its edges, of both at the same time, until the
 *  smaller one is complete, which becomes a new region. @param ring consecutive vertices */
std::optional<CellComplex::Sides> CellComplex::divide(int region, const std::vector<int>& ring)
{
  const int count = static_cast<int>(ring.size());
  const std::vector<std::pair<int, int>> barriers = barriersOf(region, ring);
  const int first_barrier = barriers.front().first;
  const auto is_barrier = [&](int a, int b)
  {
    const std::pair<int, int> edge = std::minmax(a, b);
    return edge.first >= first_barrier && std::binary_search(barriers.begin(), barriers.end(), edge);
  };
  std::array<std::vector<int>, 2> side;  // behind, before
  std::array<int, 2> mark{marks_ + 1, marks_ + 2};
  marks_ += 2;
  for (int k = 0; k < count; ++k)
  {
    const int a = ring[at(k)], b = ring[at((k + 1) % count)];
    for (const int face : faces_at_vertex_[at(b)])
    {
      const Eigen::Vector3i corners = outward(face, region);
      for (int c = 0; c < 3 && touches(face, region); ++c)
        for (const std::size_t s : {std::size_t{0}, std::size_t{1}})  // the part before the plane holds the edge a → b
          if (corners[c] == (s == 1 ? a : b) && corners[(c + 1) % 3] == (s == 1 ? b : a) && mark_[at(face)] != mark[s])
          {
            mark_[at(face)] = mark[s];
            side[s].push_back(face);
          }
    }
  }
  if (side[0].empty() || side[1].empty())
    return std::nullopt;
  std::array<std::size_t, 2> next{0, 0};
  std::size_t s = 0;
  for (; next[s] < side[s].size(); s = 1 - s)
  {
    const int face = side[s][next[s]++];
    const Eigen::Vector3i corners = faces_[at(face)].corners;
    for (int c = 0; c < 3; ++c)
    {
      const int a = corners[c], b = corners[(c + 1) % 3];
      const int other = is_barrier(a, b) ? -1 : neighbour(face, region, a, b);
      if (other < 0 || mark_[at(other)] == mark[s])
        continue;
      if (mark_[at(other)] == mark[1 - s])
        return std::nullopt;
      mark_[at(other)] = mark[s];
      side[s].push_back(other);
    }
  }
  const int created = static_cast<int>(faces_of_region_.size());
  for (const int face : side[s])
    (faces_[at(face)].plus == region ? faces_[at(face)].plus : faces_[at(face)].minus) = created;
  faces_of_region_.push_back(std::move(side[s]));
  return s == 0 ? Sides{created, region} : Sides{region, created};
}

/** Triangulates the polygon ring[first … last] by halves: triangles remain short, and what folds over cancels out. */
void CellComplex::addCaps(const std::vector<int>& ring, std::size_t first, std::size_t last, const Sides& sides)
{
  if (last < first + 2)
    return;
  const std::size_t middle = (first + last) / 2;
  append({{ring[first], ring[middle], ring[last]}, sides.behind, sides.before, -1});
  addCaps(ring, first, middle, sides);
  addCaps(ring, middle, last, sides);
}

std::optional<CellComplex::Sides> CellComplex::cut(int region, const CutPlane& plane, const Section& section)
{
  if (crossesRing(section))
    return std::nullopt;
  std::vector<int> ring;
  const std::vector<Split> splits = splitEdges(section, plane, ring);
  std::vector<int> affected;
  for (const Split& split : splits)
    for (const int face : faces_at_vertex_[at(split.low)])
      if (holds(faces_[at(face)].corners, split.low) && holds(faces_[at(face)].corners, split.high))
        affected.push_back(face);
  std::sort(affected.begin(), affected.end());
  affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
  for (const int face : affected)
    splitFace(face, splits);
  const std::optional<Sides> sides = divide(region, ring);
  if (!sides)
  {
    rings_.push_back({region, std::move(ring)});
    return std::nullopt;
  }
  addCaps(ring, 0, ring.size() - 1, *sides);
  capRings(region, *sides);
  return sides;
}

}  // namespace endovascular_sim::contrast
