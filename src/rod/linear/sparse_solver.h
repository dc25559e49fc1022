#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "rod/linear/banded_ldlt.h"

namespace endovascular_sim::rod
{

/** Compressed columns with int indices; symmetric matrices hold both triangles. */
using SparseMatrix = Eigen::SparseMatrix<double>;

/** LU factorisation with partial pivoting by SuiteSparse's KLU: any regular square matrix, saddle matrices among them.
 *
 *  Its pivots say nothing about inertia (an unsymmetric LU has no signature): a saddle matrix goes unchecked for it.
 *  The general path and the check of the banded kernel, not the fast one: it allocates at every factorisation. The
 *  ordering is found anew only when the pattern of nonzeros has changed. */
class KluSolver
{
public:
  KluSolver();
  ~KluSolver();
  KluSolver(KluSolver&&) noexcept;
  KluSolver& operator=(KluSolver&&) noexcept;

  /** @param matrix square and compressed
   *  @return false when it is singular */
  bool factorise(const SparseMatrix& matrix);

  /** Solves in place with the last factorisation, which must have succeeded.
   *  @param rhs as many entries as the matrix has rows */
  void solve(double* rhs);

private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

/** LDLᵀ factorisation of positive definite matrices by SuiteSparse's CHOLMOD, its simplicial path only. */
class CholmodSolver
{
public:
  CholmodSolver();
  ~CholmodSolver();
  CholmodSolver(CholmodSolver&&) noexcept;
  CholmodSolver& operator=(CholmodSolver&&) noexcept;

  /** @param matrix symmetric and compressed; its lower triangle is used
   *  @return false when it is not positive definite */
  bool factorise(const SparseMatrix& matrix);

  /** Solves in place with the last factorisation, which must have succeeded. */
  void solve(double* rhs);

private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

/** The nonzeros of a banded symmetric matrix, both triangles. */
template <int Bandwidth, int Period>
SparseMatrix sparseFromBand(const BandedLdlt<Bandwidth, Period>& band)
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(band.size()) * (2 * Bandwidth + 1));
  for (int col = 0; col < band.size(); ++col)
    for (int row = col; row < band.size() && row <= col + Bandwidth; ++row)
    {
      const double value = band.at(row, col);
      if (value == 0.0)
        continue;
      entries.emplace_back(row, col, value);
      if (row != col)
        entries.emplace_back(col, row, value);
    }
  SparseMatrix matrix(band.size(), band.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace endovascular_sim::rod
