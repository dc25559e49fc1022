#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "rod/linear/banded_ldlt.h"

namespace endovascular_sim::rod
{

/** Compressed columns with int indices; symmetric matrices hold both triangles. */
using SparseMatrix = Eigen::SparseMatrix<double>;

/** LU factorisation with partial pivoting by SuiteSparse's KLU, for any regular square matrix.
 *
 *  An unsymmetric LU has no signature, so that the inertia of a saddle matrix is not checked. It serves as the general
 *  solver and as a check of the banded one; it is slower and allocates at every factorisation. The ordering is
 *  recomputed only when the pattern of nonzeros changes. */
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

/** Nonzeros of a banded symmetric matrix, both triangles. */
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
