#pragma once

#include <cstdint>
#include <vector>

#include "contrast/cells/contrast_cells.h"
#include "contrast/transport/cell_tree.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::contrast
{

/** Medium that enters a cell during a time step. */
struct CellSource
{
  std::size_t cell = 0;
  double volume = 0.0;         ///< in the step [m³]
  double concentration = 0.0;  ///< iodine [kg/m³]
};

/** Blood in the cells during a time step. */
struct BloodStep
{
  std::vector<double> before;       ///< volume of each cell at the beginning [m³]
  std::vector<double> after;        ///< the same at the end [m³]
  std::vector<double> outflows;     ///< volume that leaves each cell through an outlet of the vessel [m³]
  std::vector<CellSource> sources;  ///< medium that enters
  double inlet = 0.0;               ///< concentration of the blood that enters at the inlet [kg/m³]
};

/** Constants of the transport. */
struct TransportSettings
{
  /** D/(|u|d) of the dispersion: 5.05 √(f/8), Taylor's result for a turbulent stream in a pipe (1954), is 0.31 to 0.36
   *  for friction factors f of 0.03 to 0.04. The mixing of arteries, by pulsation, bends and branches, is of this kind;
   *  a laminar stream in a straight pipe would spread more, without limit. */
  double dispersion = 0.3;
  double courant = 0.45;  ///< largest Courant number; below 0.5 all concentrations stay between those before
};

/** Transport of iodine with the blood along a tree of cells: conservative finite volumes,
 *
 *      d(c_k V_k)/dt = Σ_f Q_f c_f + Σ_f (D A/Δx)_f (c_f+ − c_k) + sources − outlets,   D = 0.3 |u| d.
 *
 *  The flow Q of a face follows from the volumes, outlets and sources behind it by continuity, from the leaves to the
 *  root; even filling therefore stays even. The concentration at a face is that upwind, linear in the volume along the
 *  vessel with the monotonised central slope and in time (MUSCL–Hancock: van Leer 1977, 1984), of second order; at a
 *  branching it is that of the cell, which is mixed. Advection is explicit, in as many substeps as the Courant number
 *  asks for in cells with iodine; dispersion is implicit, once in a step. Concentrations stay between 0 and the
 *  strongest that entered.
 *
 *  Only cells with iodine and their neighbours are computed. A cell below 1e-6 of the strongest concentration is
 *  emptied, and all are when less than 1e-9 of what was injected is inside; both count as left. */
class Transport
{
public:
  /** @param volumes of the cells at rest [m³], from which diameters follow
   *  @throws std::invalid_argument for cells that are no tree, or volumes that are not positive */
  Transport(const ContrastCells& cells, const std::vector<double>& volumes, const TransportSettings& settings = {});

  /** Advances by a step. @throws std::invalid_argument for other numbers of values than cells */
  void step(const BloodStep& blood);

  /** Sets the iodine of each cell; counts as injected [kg]. @param strongest concentration [kg/m³] */
  void fill(const std::vector<double>& masses, double strongest);

  /** Forgets all iodine, and what was injected. */
  void clear();

  std::size_t cells() const { return tree_.size(); }
  bool isEmpty() const { return inside_ == 0.0; }
  double mass(std::size_t cell) const { return masses_[cell]; }  ///< iodine [kg]
  /** Iodine per volume [kg/m³]. @param volume of the cell [m³] */
  double concentration(std::size_t cell, double volume) const;

  /** Iodine that entered, is in the cells, and has left them, since the beginning [kg]. @{ */
  double injected() const { return injected_; }
  double inside() const { return inside_; }
  double left() const { return left_; }
  /** @} */

  /** Volume through the face of a cell, away from the heart, in the last step with iodine [m³]. */
  double faceVolume(std::size_t cell) const { return faces_[cell]; }
  std::uint64_t substeps() const { return substeps_; }  ///< since the construction

  /** @throws ArchiveError for an archive of other cells */
  void archive(Archive& archive);

private:
  void check(const BloodStep& blood) const;
  void findFaces(const BloodStep& blood);
  void activate(const BloodStep& blood);
  void reach(std::size_t cell);
  void spread();
  double emptying(std::size_t first, const BloodStep& blood) const;
  void advance(const BloodStep& blood, double begin, double share);
  double faceConcentration(std::size_t donor, bool is_forward, double volume) const;
  double rise(std::size_t cell) const;
  void disperse(const BloodStep& blood);
  void settle(const BloodStep& blood);

  CellTree tree_;
  TransportSettings settings_;
  std::vector<double> mixing_;  // of each face: D A/(Δx |Q|)
  std::vector<double> masses_;  // [kg]
  double injected_ = 0.0, inside_ = 0.0, left_ = 0.0;
  double strongest_ = 0.0;  // concentration that has entered [kg/m³]
  std::uint64_t substeps_ = 0;

  std::vector<double> faces_;                            // volume through each face in the step [m³]
  std::vector<double> volumes_, concentrations_, flux_;  // in a substep; zero in cells that are not active
  std::vector<double> diagonal_;
  std::vector<std::size_t> active_;               // cells with iodine and their neighbours
  std::vector<char> is_active_, has_neighbours_;  // of each cell: it, and its neighbours, are in active_
};

}  // namespace endovascular_sim::contrast
