#include "contrast/transport/transport.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::contrast
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kTrace = 1e-6;  // share of the strongest concentration below which a cell is emptied
constexpr double kRest = 1e-9;   // share of the injected iodine below which all cells are emptied

std::size_t indexOf(int cell)
{
  return static_cast<std::size_t>(cell);
}

}  // namespace

Transport::Transport(const ContrastCells& cells, const std::vector<double>& volumes, const TransportSettings& settings)
  : tree_(cells), settings_(settings)
{
  const std::size_t count = cells.size();
  if (volumes.size() != count)
    throw std::invalid_argument("contrast: a volume is needed for each cell");
  std::vector<double> diameters;
  for (std::size_t k = 0; k < count; ++k)
  {
    if (!(std::isfinite(volumes[k]) && volumes[k] > 0.0))
      throw std::invalid_argument("contrast: the volume of cell " + std::to_string(k) + " must be positive");
    diameters.push_back(2.0 * std::sqrt(volumes[k] / (kPi * tree_.length(k))));
  }
  mixing_.assign(count, 0.0);
  for (std::size_t k = 0; k < count; ++k)
    if (tree_.parent(k) >= 0)
    {
      const std::size_t parent = indexOf(tree_.parent(k));
      mixing_[k] = settings_.dispersion * std::min(diameters[parent], diameters[k]) /
                   (0.5 * (tree_.length(parent) + tree_.length(k)));
    }
  masses_.assign(count, 0.0);
  faces_.assign(count, 0.0);
  volumes_.assign(count, 0.0);
  concentrations_.assign(count, 0.0);
  flux_.assign(count, 0.0);
  diagonal_.assign(count, 0.0);
  is_active_.assign(count, 0);
  has_neighbours_.assign(count, 0);
}

void Transport::check(const BloodStep& blood) const
{
  if (blood.before.size() != cells() || blood.after.size() != cells() || blood.outflows.size() != cells())
    throw std::invalid_argument("contrast: volumes and outflows are needed for each cell");
  for (const CellSource& source : blood.sources)
    if (source.cell >= cells())
      throw std::invalid_argument("contrast: a source is in no cell");
}

void Transport::step(const BloodStep& blood)
{
  check(blood);
  if (inside_ == 0.0 && blood.sources.empty() && blood.inlet == 0.0)
    return;
  strongest_ = std::max(strongest_, blood.inlet);
  for (const CellSource& source : blood.sources)
    strongest_ = std::max(strongest_, source.concentration);
  findFaces(blood);
  activate(blood);
  double begin = 0.0, fastest = 0.0;  // share of the step that is done; largest share of a cell that leaves in a step
  for (std::size_t seen = 0; begin < 1.0;)
  {
    fastest = std::max(fastest, emptying(seen, blood));
    seen = active_.size();
    const double count = std::max(1.0, std::ceil((1.0 - begin) * fastest / settings_.courant));
    const double share = count > 1.0 ? (1.0 - begin) / count : 1.0 - begin;
    advance(blood, begin, share);
    begin = count > 1.0 ? begin + share : 1.0;
    spread();
    ++substeps_;
  }
  disperse(blood);
  settle(blood);
}

/** Volumes through the faces by continuity, from the leaves to the root. */
void Transport::findFaces(const BloodStep& blood)
{
  for (std::size_t k = 0; k < cells(); ++k)
    faces_[k] = blood.after[k] - blood.before[k] + blood.outflows[k];
  for (const CellSource& source : blood.sources)
    faces_[source.cell] -= source.volume;
  for (std::size_t k = cells(); k-- > 0;)
    if (tree_.parent(k) >= 0)
      faces_[indexOf(tree_.parent(k))] += faces_[k];
}

/** Lists the cells with iodine and their neighbours. */
void Transport::activate(const BloodStep& blood)
{
  for (const std::size_t cell : active_)
  {
    is_active_[cell] = has_neighbours_[cell] = 0;
    concentrations_[cell] = flux_[cell] = 0.0;
  }
  active_.clear();
  for (std::size_t k = 0; k < cells(); ++k)
    if (masses_[k] > 0.0)
      reach(k);
  for (const CellSource& source : blood.sources)
    reach(source.cell);
  if (blood.inlet > 0.0)
    for (std::size_t k = 0; k < cells(); ++k)
      if (tree_.parent(k) < 0)
        reach(k);
  spread();
}

void Transport::reach(std::size_t cell)
{
  if (is_active_[cell] != 0)
    return;
  is_active_[cell] = 1;
  active_.push_back(cell);
}

/** Adds the neighbours of cells with iodine. */
void Transport::spread()
{
  const std::size_t count = active_.size();
  for (std::size_t n = 0; n < count; ++n)
  {
    const std::size_t k = active_[n];
    if (has_neighbours_[k] != 0 || masses_[k] == 0.0)
      continue;
    has_neighbours_[k] = 1;
    if (tree_.parent(k) >= 0)
      reach(indexOf(tree_.parent(k)));
    for (const std::size_t* child = tree_.childrenBegin(k); child != tree_.childrenEnd(k); ++child)
      reach(*child);
  }
}

/** Largest volume that leaves an active cell in a step, relative to its own, of the cells from @p first on. */
double Transport::emptying(std::size_t first, const BloodStep& blood) const
{
  double largest = 0.0;
  for (std::size_t n = first; n < active_.size(); ++n)
  {
    const std::size_t k = active_[n];
    double out = std::max(-faces_[k], 0.0) + std::max(blood.outflows[k], 0.0);
    for (const std::size_t* child = tree_.childrenBegin(k); child != tree_.childrenEnd(k); ++child)
      out += std::max(faces_[*child], 0.0);
    largest = std::max(largest, out / std::min(blood.before[k], blood.after[k]));
  }
  return largest;
}

/** Change of the concentration from the middle of a cell to its next one's face, limited. */
double Transport::rise(std::size_t cell) const
{
  const int before = tree_.previous(cell), behind = tree_.next(cell);
  if (before < 0 || behind < 0)
    return 0.0;
  const double a = concentrations_[cell] - concentrations_[indexOf(before)];
  const double b = concentrations_[indexOf(behind)] - concentrations_[cell];
  if (a * b <= 0.0)
    return 0.0;
  const double volume = volumes_[cell];
  const double wide_a = volumes_[indexOf(before)] + volume, wide_b = volume + volumes_[indexOf(behind)];
  const double central = volume * (a * wide_b * wide_b + b * wide_a * wide_a) / (wide_a * wide_b * (wide_a + wide_b));
  return std::copysign(std::min({std::abs(central), std::abs(a), std::abs(b)}), a);
}

/** Mean concentration in a substep at the face of a cell, on the side of the next cell or on that of the heart.
 *  @param volume that leaves through the face in the substep [m³] */
double Transport::faceConcentration(std::size_t donor, bool is_forward, double volume) const
{
  const double half = rise(donor) * (1.0 - volume / volumes_[donor]);
  return concentrations_[donor] + (is_forward ? half : -half);
}

/** Advection and sources in a share of the step that begins after the share @p begin of it. */
void Transport::advance(const BloodStep& blood, double begin, double share)
{
  for (const std::size_t k : active_)
  {
    volumes_[k] = blood.before[k] + begin * (blood.after[k] - blood.before[k]);
    concentrations_[k] = masses_[k] / volumes_[k];
  }
  for (const std::size_t k : active_)
  {
    const double volume = share * faces_[k];
    const int parent = tree_.parent(k);
    if (volume < 0.0)
      flux_[k] = masses_[k] == 0.0 ? 0.0 : volume * faceConcentration(k, false, -volume);
    else if (parent < 0)
      flux_[k] = volume * blood.inlet;
    else if (masses_[indexOf(parent)] == 0.0)
      flux_[k] = 0.0;
    else
      flux_[k] = volume * (tree_.next(indexOf(parent)) == static_cast<int>(k)
                               ? faceConcentration(indexOf(parent), true, volume)
                               : concentrations_[indexOf(parent)]);
  }
  for (const std::size_t k : active_)
  {
    double change = flux_[k];
    for (const std::size_t* child = tree_.childrenBegin(k); child != tree_.childrenEnd(k); ++child)
      change -= flux_[*child];
    if (tree_.parent(k) < 0)
    {
      injected_ += std::max(flux_[k], 0.0);
      left_ += std::max(-flux_[k], 0.0);
    }
    if (blood.outflows[k] > 0.0)
    {
      const double out = share * blood.outflows[k] * concentrations_[k];
      change -= out;
      left_ += out;
    }
    masses_[k] += change;
  }
  for (const CellSource& source : blood.sources)
  {
    const double mass = share * source.volume * source.concentration;
    masses_[source.cell] += mass;
    injected_ += mass;
  }
}

/** Implicit step of the dispersion between active cells: a symmetric M-matrix on the tree, which is eliminated from the
 *  leaves to the root. */
void Transport::disperse(const BloodStep& blood)
{
  if (settings_.dispersion <= 0.0)
    return;
  active_.clear();
  for (std::size_t k = 0; k < cells(); ++k)  // ascending
    if (is_active_[k] != 0)
      active_.push_back(k);
  std::vector<double>& weights = flux_;  // of the faces between active cells; fluxes are no longer needed
  for (const std::size_t k : active_)
  {
    const int parent = tree_.parent(k);
    weights[k] = parent >= 0 && is_active_[indexOf(parent)] != 0 ? mixing_[k] * std::abs(faces_[k]) : 0.0;
    diagonal_[k] = blood.after[k] + weights[k];
    concentrations_[k] = masses_[k];  // right side
    if (weights[k] > 0.0)
      diagonal_[indexOf(parent)] += weights[k];
  }
  for (auto k = active_.rbegin(); k != active_.rend(); ++k)
    if (weights[*k] > 0.0)
    {
      const std::size_t parent = indexOf(tree_.parent(*k));
      const double multiplier = weights[*k] / diagonal_[*k];
      diagonal_[parent] -= weights[*k] * multiplier;
      concentrations_[parent] += multiplier * concentrations_[*k];
    }
  for (const std::size_t k : active_)
  {
    const double from_parent = weights[k] > 0.0 ? weights[k] * concentrations_[indexOf(tree_.parent(k))] : 0.0;
    concentrations_[k] = (concentrations_[k] + from_parent) / diagonal_[k];
    masses_[k] = concentrations_[k] * blood.after[k];
  }
}

/** Empties cells with traces, and adds up what is inside. */
void Transport::settle(const BloodStep& blood)
{
  inside_ = 0.0;
  for (const std::size_t k : active_)
  {
    if (masses_[k] < kTrace * strongest_ * blood.after[k])
    {
      left_ += masses_[k];
      masses_[k] = 0.0;
    }
    inside_ += masses_[k];
  }
  if (inside_ > kRest * injected_ || !blood.sources.empty() || blood.inlet > 0.0)
    return;
  left_ += inside_;
  inside_ = 0.0;
  for (const std::size_t k : active_)
    masses_[k] = 0.0;
}

void Transport::fill(const std::vector<double>& masses, double strongest)
{
  if (masses.size() != cells())
    throw std::invalid_argument("contrast: a mass is needed for each cell");
  left_ += inside_;
  masses_ = masses;
  inside_ = std::accumulate(masses_.begin(), masses_.end(), 0.0);
  injected_ += inside_;
  strongest_ = std::max(strongest_, strongest);
}

void Transport::clear()
{
  masses_.assign(cells(), 0.0);
  injected_ = inside_ = left_ = strongest_ = 0.0;
}

double Transport::concentration(std::size_t cell, double volume) const
{
  return std::min(masses_[cell] / volume, strongest_);
}

void Transport::archive(Archive& archive)
{
  std::vector<std::uint32_t> filled;
  std::vector<double> masses;
  for (std::size_t k = 0; k < cells() && !archive.reading(); ++k)
    if (masses_[k] > 0.0)
    {
      filled.push_back(static_cast<std::uint32_t>(k));
      masses.push_back(masses_[k]);
    }
  archive(filled, masses, injected_, inside_, left_, strongest_);
  if (!archive.reading())
    return;
  requireLength(filled.size(), masses);
  requireFinite(masses, injected_, inside_, left_, strongest_);
  masses_.assign(cells(), 0.0);
  for (std::size_t n = 0; n < filled.size(); ++n)
  {
    requireLoaded(filled[n] < cells() && masses[n] >= 0.0, "holds contrast medium of another vessel");
    masses_[filled[n]] = masses[n];
  }
}

}  // namespace endovascular_sim::contrast
