#pragma once

#include <cstddef>
#include <vector>

#include "flow/body/vessel_flow_tree.h"
#include "flow/network/flow_network.h"

namespace endovascular_sim::flow
{

/** Lumen of a stretch of a branch that differs from the healthy one: a lesion, or what a balloon or a stent made of it.
 */
struct LumenProfile
{
  int branch = 0;
  std::vector<double> arcs;   ///< arc lengths on the branch, increasing [m]
  std::vector<double> areas;  ///< of the lumen there [m²]

  /** Area at an arc length by linear interpolation [m²]; @p healthy outside of the stretch. */
  double areaAt(double arc, double healthy) const;
  bool holds(double arc) const { return !arcs.empty() && arc >= arcs.front() && arc <= arcs.back(); }
  bool operator==(const LumenProfile& other) const
  {
    return branch == other.branch && arcs == other.arcs && areas == other.areas;
  }
};

/** Piece of an instrument or of a balloon in a branch. */
struct InstrumentSpan
{
  int branch = 0;
  double begin = 0.0;  ///< arc lengths on the branch [m]
  double end = 0.0;
  double radius = 0.0;  ///< outer [m]
};

/** Resistance per length of a tube with a concentric cylinder in it, relative to that of the empty tube:
 *  1/(1 − λ⁴ − (1 − λ²)²/ln(1/λ)) with λ the ratio of the radii (Bird, Stewart & Lightfoot 2002, eq. 2.4-17).
 *  @param ratio λ, 0 to 1; infinity at 1 */
double annulusFactor(double ratio);

/** Obstacles of the cells of a vessel: narrowed lumens, and the annulus that instruments leave.
 *
 *  A cell is divided into parts of at most 0.25 mm; ends of instruments are rounded to them. The viscous resistance is
 *  that of the local area. Behind the narrowest place of a lesion the jet loses
 *  Δp = K_t ρ/(2A₀²)·(A₀/A_s − 1)²·Q|Q| with K_t = 1.52 (Young & Tsai 1973), A₀ the healthy area and A_s the free one.
 *  A lesion over several cells has one jet, that of the largest loss. A cell is closed where the lumen has less than
 * 0.1 % of the healthy area, 97 % of the diameter narrowed, and where an instrument leaves less than 2 %: it touches
 * the wall of a lumen that is not round.
 *
 *  The obstacles are functions of the present lumens and instruments; only those of cells in which something changed
 *  are computed again. */
class Obstruction
{
public:
  Obstruction(const VesselFlowTree& vessel, const FlowSettings& blood);

  /** Sets what narrows the vessel.
   *  @return cells whose obstacles have changed */
  const std::vector<std::size_t>& update(const std::vector<LumenProfile>& lumens,
                                         const std::vector<InstrumentSpan>& instruments);

  const FlowObstacle& obstacle(std::size_t cell) const { return obstacles_[cell]; }

  /** Share of a cell's pressure drop between its beginning and a place: that of the free blood is uniform, that of an
   *  obstacle lies where the obstacle is, and that of the jet behind the narrowest part.
   *  @param arc length on the branch [m]
   *  @param area of the free lumen of the cell [m²]
   *  @param flow in the cell [m³/s] */
  double dropUpTo(std::size_t cell, double arc, double area, double flow) const;

private:
  /** What a cell is without obstacles. */
  struct Cell
  {
    CellPlace place;
    int parts;         // into which it is divided
    double healthy;    // area [m²]
    double friction;   // resistance per length and squared area, 2(γ+2)πµ [Pa·s]
    bool is_followed;  // by the next cell, at the same node
  };

  /** Instrument in the parts from `first` to before `last` of a cell. */
  struct Piece
  {
    int first, last;
    double radius;  // [m]
    bool operator==(const Piece& other) const
    {
      return first == other.first && last == other.last && radius == other.radius;
    }
  };

  /** Part of a cell. */
  struct Part
  {
    double radius;  // of the instrument [m]
    double free;    // area between lumen and instrument [m²]
    double extra;   // resistance per friction and length, beyond that of the healthy area; infinite where closed
  };

  static int partAt(const Cell& cell, double arc);
  void place(const InstrumentSpan& span);
  void addLumens(const std::vector<LumenProfile>& lumens, bool is_present);
  void add(std::size_t cell, std::vector<std::size_t>& list);
  void partsOf(std::size_t cell, std::vector<Part>& parts) const;
  FlowObstacle obstacleOf(std::size_t cell);
  bool hasJet(std::size_t cell) const;

  double density_;  // of the blood [kg/m³]
  std::vector<Cell> cells_;
  std::vector<CellRange> ranges_;  // of each branch
  std::vector<LumenProfile> lumens_;
  std::vector<char> has_lumen_;                       // of each cell
  std::vector<std::vector<Piece>> pieces_, present_;  // of each cell; while it is updated: before, and now
  std::vector<FlowObstacle> own_, obstacles_;         // of each cell: with its own jet, and with that of the lesion
  std::vector<std::size_t> occupied_, visited_, renewed_, changed_;  // lists of cells
  std::vector<char> is_listed_;                                      // in visited_, or in renewed_
  std::vector<Part> parts_;
};

}  // namespace endovascular_sim::flow
