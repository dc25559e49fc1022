#include "flow/body/obstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kLossCoefficient = 1.52;  // K_t of Young & Tsai 1973
constexpr double kLongestPart = 2.5e-4;    // [m]
constexpr double kFilled = 0.02;           // free share of the healthy area that an instrument fills
constexpr double kClosed = 1e-3;           // free share of the healthy area below which a lumen is closed
constexpr double kThin = 1e-3;             // ratio of radii below which an instrument has no effect

}  // namespace

double LumenProfile::areaAt(double arc, double healthy) const
{
  if (!holds(arc))
    return healthy;
  const auto after = std::upper_bound(arcs.begin(), arcs.end(), arc);
  if (after == arcs.end())
    return areas.back();
  const auto k = static_cast<std::size_t>(after - arcs.begin());
  const double share = (arc - arcs[k - 1]) / (arcs[k] - arcs[k - 1]);
  return areas[k - 1] + share * (areas[k] - areas[k - 1]);
}

double annulusFactor(double ratio)
{
  if (ratio <= 0.0)
    return 1.0;
  if (ratio >= 1.0)
    return std::numeric_limits<double>::infinity();
  const double square = ratio * ratio, ring = 1.0 - square;
  return 1.0 / (1.0 - square * square + ring * ring / std::log(ratio));
}

Obstruction::Obstruction(const VesselFlowTree& vessel, const FlowSettings& blood)
  : density_(blood.density), ranges_(vessel.ranges)
{
  const std::vector<FlowCell>& cells = vessel.tree.cells;
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    const CellPlace& place = vessel.places[k];
    const int parts = std::max(2, static_cast<int>(std::ceil((place.end - place.begin) / kLongestPart)));
    cells_.push_back({place, parts, cells[k].wall.area, 2.0 * (cells[k].profile + 2.0) * kPi * blood.viscosity,
                      k + 1 < cells.size() && cells[k].to == cells[k + 1].from});
  }
  has_lumen_.assign(cells.size(), 0);
  pieces_.resize(cells.size());
  present_.resize(cells.size());
  own_.resize(cells.size());
  obstacles_.resize(cells.size());
  is_listed_.assign(cells.size(), 0);
}

/** Nearest boundary between two parts of a cell; 0 before it, the number of its parts behind it. */
int Obstruction::partAt(const Cell& cell, double arc)
{
  const double along = (arc - cell.place.begin) / (cell.place.end - cell.place.begin) * cell.parts;
  return static_cast<int>(std::clamp(std::floor(along + 0.5), 0.0, static_cast<double>(cell.parts)));
}

void Obstruction::add(std::size_t cell, std::vector<std::size_t>& list)
{
  if (is_listed_[cell] != 0)
    return;
  is_listed_[cell] = 1;
  list.push_back(cell);
}

/** Adds the pieces of an instrument to the cells in which it lies. */
void Obstruction::place(const InstrumentSpan& span)
{
  if (span.branch < 0 || static_cast<std::size_t>(span.branch) >= ranges_.size() || !(span.radius > 0.0) ||
      !(span.begin < span.end))
    return;
  const CellRange& range = ranges_[static_cast<std::size_t>(span.branch)];
  const auto last = cells_.begin() + static_cast<std::ptrdiff_t>(range.end);
  auto cell = std::partition_point(cells_.begin() + static_cast<std::ptrdiff_t>(range.begin), last,
                                   [&span](const Cell& candidate) { return candidate.place.end <= span.begin; });
  for (; cell != last && cell->place.begin < span.end; ++cell)
  {
    const bool is_within = span.begin <= cell->place.begin && cell->place.end <= span.end;
    const Piece piece = is_within ? Piece{0, cell->parts, span.radius}
                                  : Piece{partAt(*cell, span.begin), partAt(*cell, span.end), span.radius};
    if (piece.first >= piece.last)
      continue;
    const auto k = static_cast<std::size_t>(cell - cells_.begin());
    std::vector<Piece>& pieces = present_[k];
    add(k, visited_);
    const bool continues = !pieces.empty() && pieces.back().radius == piece.radius &&
                           pieces.back().first <= piece.first && piece.first <= pieces.back().last;
    if (continues)
      pieces.back().last = std::max(pieces.back().last, piece.last);
    else
      pieces.push_back(piece);
  }
}

/** Selects the cells of lumens for renewal. @param is_present false: of lumens that are no longer there */
void Obstruction::addLumens(const std::vector<LumenProfile>& lumens, bool is_present)
{
  for (const LumenProfile& lumen : lumens)
  {
    if (lumen.branch < 0 || static_cast<std::size_t>(lumen.branch) >= ranges_.size() || lumen.arcs.empty())
      continue;
    const CellRange& range = ranges_[static_cast<std::size_t>(lumen.branch)];
    for (std::size_t k = range.begin; k < range.end; ++k)
    {
      const CellPlace& place = cells_[k].place;
      if (place.end < lumen.arcs.front() || place.begin > lumen.arcs.back())
        continue;
      has_lumen_[k] = is_present ? 1 : 0;
      add(k, renewed_);
    }
  }
}

const std::vector<std::size_t>& Obstruction::update(const std::vector<LumenProfile>& lumens,
                                                    const std::vector<InstrumentSpan>& instruments)
{
  renewed_.clear();
  visited_.clear();
  changed_.clear();
  for (const InstrumentSpan& span : instruments)
    place(span);
  const std::size_t occupied = visited_.size();
  for (const std::size_t cell : occupied_)
    add(cell, visited_);
  for (const std::size_t cell : visited_)
  {
    is_listed_[cell] = 0;
    if (present_[cell] == pieces_[cell])
      continue;
    pieces_[cell] = present_[cell];
    add(cell, renewed_);
  }
  for (const std::size_t cell : visited_)
    present_[cell].clear();
  visited_.resize(occupied);
  occupied_.swap(visited_);
  if (!(lumens == lumens_))
  {
    addLumens(lumens_, false);
    addLumens(lumens, true);
    lumens_ = lumens;
  }
  for (const std::size_t cell : renewed_)
  {
    is_listed_[cell] = 0;
    own_[cell] = obstacleOf(cell);
  }
  for (const std::size_t cell : renewed_)
    for (std::size_t k = cell > 0 ? cell - 1 : 0; k < std::min(cell + 2, cells_.size()); ++k)
    {
      FlowObstacle obstacle = own_[k];
      obstacle.loss = hasJet(k) ? obstacle.loss : 0.0;
      if (obstacle == obstacles_[k])
        continue;
      obstacles_[k] = obstacle;
      changed_.push_back(k);
    }
  return changed_;
}

/** True if the loss of a cell is larger than those of its neighbours. */
bool Obstruction::hasJet(std::size_t cell) const
{
  if (cells_[cell].is_followed && own_[cell].loss < own_[cell + 1].loss)
    return false;
  return cell == 0 || !cells_[cell - 1].is_followed || own_[cell - 1].loss < own_[cell].loss;
}

/** Parts of a cell with what lies in them. */
void Obstruction::partsOf(std::size_t index, std::vector<Part>& parts) const
{
  const Cell& cell = cells_[index];
  parts.assign(static_cast<std::size_t>(cell.parts), {0.0, cell.healthy, 0.0});
  for (const Piece& piece : pieces_[index])
    for (auto k = static_cast<std::size_t>(piece.first); k < static_cast<std::size_t>(piece.last); ++k)
      parts[k].radius = std::max(parts[k].radius, piece.radius);
  double radius = 0.0, lumen = cell.healthy, extra = 0.0;  // of the part before
  for (std::size_t k = 0; k < parts.size(); ++k)
  {
    Part& part = parts[k];
    double area = cell.healthy;
    const double arc =
        cell.place.begin + (cell.place.end - cell.place.begin) * (static_cast<double>(k) + 0.5) / cell.parts;
    if (has_lumen_[index] != 0)
      for (const LumenProfile& profile : lumens_)
        if (profile.branch == cell.place.branch && profile.holds(arc))
        {
          area = profile.areaAt(arc, cell.healthy);
          break;
        }
    if (part.radius != radius || area != lumen)
    {
      radius = part.radius;
      lumen = area;
      const double ratio = radius / std::sqrt(lumen / kPi);
      const double factor = ratio < kThin ? 1.0 : annulusFactor(ratio);
      extra = lumen - kPi * radius * radius <= (radius > 0.0 ? kFilled : kClosed) * cell.healthy
                  ? std::numeric_limits<double>::infinity()
                  : factor / (lumen * lumen) - 1.0 / (cell.healthy * cell.healthy);
    }
    part = {radius, lumen - kPi * radius * radius, extra};
  }
}

/** Obstacle of a cell with a jet of its own. */
FlowObstacle Obstruction::obstacleOf(std::size_t index)
{
  const Cell& cell = cells_[index];
  if (pieces_[index].empty() && has_lumen_[index] == 0)
    return {};
  partsOf(index, parts_);
  double extra = 0.0, narrowest = cell.healthy, blocked = 0.0;
  for (const Part& part : parts_)
  {
    if (std::isinf(part.extra))
      return {std::numeric_limits<double>::infinity(), 0.0, 0.0};
    narrowest = std::min(narrowest, part.free);
    extra += part.extra;
    blocked += kPi * part.radius * part.radius / cell.parts;
  }
  FlowObstacle obstacle;
  obstacle.resistance = std::max(cell.friction * extra / cell.parts * (cell.place.end - cell.place.begin), 0.0);
  obstacle.blocked = std::min(blocked, 0.5 * cell.healthy);  // the area of the inertia; the resistance holds the rest
  const double jet = cell.healthy / narrowest - 1.0;
  obstacle.loss = kLossCoefficient * density_ / (2.0 * cell.healthy * cell.healthy) * jet * jet;
  return obstacle;
}

double Obstruction::dropUpTo(std::size_t index, double arc, double area, double flow) const
{
  const Cell& cell = cells_[index];
  const double length = cell.place.end - cell.place.begin;
  const double share = std::clamp((arc - cell.place.begin) / length, 0.0, 1.0);
  if (pieces_[index].empty() && has_lumen_[index] == 0)
    return share;
  std::vector<Part> parts;
  partsOf(index, parts);
  const auto here = parts.begin() + partAt(cell, arc);
  const auto isClosed = [](const Part& part) { return std::isinf(part.extra); };
  if (const auto closed = std::count_if(parts.begin(), parts.end(), isClosed); closed > 0)
    return static_cast<double>(std::count_if(parts.begin(), here, isClosed)) / static_cast<double>(closed);
  const auto extraOf = [&](auto begin, auto end)
  {
    double sum = 0.0;
    for (; begin != end; ++begin)
      sum += std::max(begin->extra, 0.0);
    return cell.friction * length / cell.parts * sum;
  };
  const auto isNarrower = [](const Part& a, const Part& b) { return a.free < b.free; };
  const auto isWider = [](const Part& a, const Part& b) { return b.free < a.free; };
  // The last narrowest part in the direction of the flow.
  const auto throat = flow < 0.0 ? std::min_element(parts.begin(), parts.end(), isNarrower)
                                 : std::max_element(parts.rbegin(), parts.rend(), isWider).base() - 1;
  const double least = std::max(area, kFilled * cell.healthy);
  const double free = cell.friction * length / (least * least), jet = obstacles_[index].loss * std::abs(flow);
  return (free * share + extraOf(parts.begin(), here) + (throat < here ? jet : 0.0)) /
         (free + extraOf(parts.begin(), parts.end()) + jet);
}

}  // namespace endovascular_sim::flow
