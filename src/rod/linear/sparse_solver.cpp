#include "rod/linear/sparse_solver.h"

#include <algorithm>

#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>

namespace endovascular_sim::rod
{
namespace
{

/** Pattern of nonzeros that an ordering was computed for. */
struct Pattern
{
  std::vector<int> begin, row;

  /** Takes over a matrix's pattern.
   *  @return true when it differs from the last one */
  bool update(const SparseMatrix& matrix)
  {
    const int* outer = matrix.outerIndexPtr();
    const int* inner = matrix.innerIndexPtr();
    const auto size = static_cast<std::size_t>(matrix.cols()) + 1;
    const auto nonzeros = static_cast<std::size_t>(matrix.nonZeros());
    if (begin.size() == size && row.size() == nonzeros && std::equal(begin.begin(), begin.end(), outer) &&
        std::equal(row.begin(), row.end(), inner))
      return false;
    begin.assign(outer, outer + size);
    row.assign(inner, inner + nonzeros);
    return true;
  }
};

}  // namespace

struct KluSolver::Factors
{
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  Pattern pattern;
  std::vector<double> value;

  Factors() { klu_defaults(&common); }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;
  ~Factors()
  {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
};

KluSolver::KluSolver() : factors_(std::make_unique<Factors>()) {}
KluSolver::~KluSolver() = default;
KluSolver::KluSolver(KluSolver&&) noexcept = default;
KluSolver& KluSolver::operator=(KluSolver&&) noexcept = default;

bool KluSolver::factorise(const SparseMatrix& matrix)
{
  Factors& f = *factors_;
  klu_free_numeric(&f.numeric, &f.common);
  if (f.pattern.update(matrix) || f.symbolic == nullptr)
  {
    klu_free_symbolic(&f.symbolic, &f.common);
    f.symbolic = klu_analyze(static_cast<int>(matrix.cols()), f.pattern.begin.data(), f.pattern.row.data(), &f.common);
  }
  if (f.symbolic == nullptr)
    return false;
  f.value.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
  f.numeric = klu_factor(f.pattern.begin.data(), f.pattern.row.data(), f.value.data(), f.symbolic, &f.common);
  return f.numeric != nullptr && f.common.status == KLU_OK;
}

void KluSolver::solve(double* rhs)
{
  klu_solve(factors_->symbolic, factors_->numeric, static_cast<int>(factors_->pattern.begin.size()) - 1, 1, rhs,
            &factors_->common);
}

struct CholmodSolver::Factors
{
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  Pattern pattern;
  std::vector<double> value;

  Factors()
  {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 0;
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
  }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;
  ~Factors()
  {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  /** View of the last matrix in CHOLMOD's format. */
  cholmod_sparse view()
  {
    cholmod_sparse sparse{};
    sparse.nrow = sparse.ncol = pattern.begin.size() - 1;
    sparse.nzmax = pattern.row.size();
    sparse.p = pattern.begin.data();
    sparse.i = pattern.row.data();
    sparse.x = value.data();
    sparse.stype = -1;
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = CHOLMOD_REAL;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.sorted = 1;
    sparse.packed = 1;
    return sparse;
  }

  /** True when D is positive; the factorisation itself continues past negative pivots. */
  bool positive() const
  {
    if (common.status != CHOLMOD_OK || factor->minor < factor->n)
      return false;
    const int* begin = static_cast<const int*>(factor->p);
    const double* entry = static_cast<const double*>(factor->x);
    for (std::size_t col = 0; col < factor->n; ++col)
      if (!(entry[begin[col]] > 0.0))
        return false;
    return true;
  }
};

CholmodSolver::CholmodSolver() : factors_(std::make_unique<Factors>()) {}
CholmodSolver::~CholmodSolver() = default;
CholmodSolver::CholmodSolver(CholmodSolver&&) noexcept = default;
CholmodSolver& CholmodSolver::operator=(CholmodSolver&&) noexcept = default;

bool CholmodSolver::factorise(const SparseMatrix& matrix)
{
  Factors& f = *factors_;
  f.value.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
  const bool changed = f.pattern.update(matrix);
  cholmod_sparse sparse = f.view();
  if (changed || f.factor == nullptr)
  {
    cholmod_free_factor(&f.factor, &f.common);
    f.factor = cholmod_analyze(&sparse, &f.common);
  }
  return f.factor != nullptr && cholmod_factorize(&sparse, f.factor, &f.common) && f.positive();
}

void CholmodSolver::solve(double* rhs)
{
  Factors& f = *factors_;
  cholmod_dense b{};
  b.nrow = b.d = b.nzmax = f.factor->n;
  b.ncol = 1;
  b.x = rhs;
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, f.factor, &b, &f.common);
  std::copy_n(static_cast<const double*>(x->x), f.factor->n, rhs);
  cholmod_free_dense(&x, &f.common);
}

}  // namespace endovascular_sim::rod
