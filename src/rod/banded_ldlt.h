#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace endovascular_sim::rod
{

/** Symmetric banded matrix with its LDLᵀ factorisation without pivoting.
 *
 *  Lower band, column storage: entry (row, col), col ≤ row ≤ col + Bandwidth. It serves positive definite and
 *  quasi-definite (saddle) matrices whose ordering keeps every pivot away from zero; the number of negative pivots
 *  is then the number of constraints, which checks every factorisation for free. */
template <int Bandwidth>
class BandedLdlt
{
public:
  static constexpr int kStride = Bandwidth + 1;

  /** Sets the size and zeroes the band; allocates only when it grows. */
  void reset(int size)
  {
    size_ = size;
    band_.resize(static_cast<std::size_t>(size) * kStride);
    std::fill(band_.begin(), band_.end(), 0.0);
  }

  int size() const { return size_; }

  /** Entry of the lower triangle, col ≤ row ≤ col + Bandwidth. */
  double& at(int row, int col) { return band_[static_cast<std::size_t>(col) * kStride + (row - col)]; }
  double at(int row, int col) const { return band_[static_cast<std::size_t>(col) * kStride + (row - col)]; }

  /** Copies another matrix's entries; allocates only when it grows. */
  void copyFrom(const BandedLdlt& other)
  {
    size_ = other.size_;
    band_.assign(other.band_.begin(), other.band_.end());
  }

  /** Replaces equation @p index by x[index] = value·pivot/pivot, keeping symmetry; @p pivot is its diagonal entry. */
  void prescribe(int index, double value, double pivot, std::vector<double>& rhs)
  {
    for (int k = 1; k <= Bandwidth && index + k < size_; ++k)
    {
      rhs[index + k] -= at(index + k, index) * value;
      at(index + k, index) = 0.0;
    }
    for (int k = 1; k <= Bandwidth && index - k >= 0; ++k)
    {
      rhs[index - k] -= at(index, index - k) * value;
      at(index, index - k) = 0.0;
    }
    at(index, index) = pivot;
    rhs[index] = pivot * value;
  }

  /** Factorises in place.
   *  @return the number of negative pivots, or −1 when a pivot is zero or not a number */
  int factorise()
  {
    int negative = 0;
    for (int col = 0; col < size_; ++col)
    {
      double* column = band_.data() + static_cast<std::size_t>(col) * kStride;
      const double pivot = column[0];
      if (!(pivot != 0.0) || pivot != pivot)
        return -1;
      negative += pivot < 0.0;
      const int below = std::min(Bandwidth, size_ - 1 - col);
      if (below == Bandwidth)
        eliminateFull(column, 1.0 / pivot, std::make_integer_sequence<int, Bandwidth>());
      else
        eliminate(column, 1.0 / pivot, below);
    }
    return negative;
  }

  /** Solves in place with the factors. */
  void solve(std::vector<double>& rhs) const
  {
    const double* band = band_.data();
    double* x = rhs.data();
    // Sums run from the farthest entry to the nearest, the only one that was not known long before.
    for (int row = 1; row < size_; ++row)
    {
      const double* entry = band + static_cast<std::size_t>(row) * kStride;  // of the diagonal
      double sum = 0.0;
      if (row >= Bandwidth)
#pragma GCC unroll 16
        for (int k = Bandwidth; k >= 1; --k)
          sum += entry[k - k * kStride] * x[row - k];
      else
        for (int k = row; k >= 1; --k)
          sum += entry[k - k * kStride] * x[row - k];
      x[row] -= sum;
    }
    for (int col = size_ - 1; col >= 0; --col)
    {
      const double* column = band + static_cast<std::size_t>(col) * kStride;
      double sum = 0.0;
      if (col + Bandwidth < size_)
#pragma GCC unroll 16
        for (int k = Bandwidth; k >= 1; --k)
          sum += column[k] * x[col + k];
      else
        for (int k = size_ - 1 - col; k >= 1; --k)
          sum += column[k] * x[col + k];
      x[col] = x[col] / column[0] - sum;
    }
  }

private:
  template <int... Index>
  static void eliminateFull(double* __restrict column, double inverse, std::integer_sequence<int, Index...>)
  {
    (subtract<Index + 1>(column, column[Index + 1] * inverse), ...);
    ((column[Index + 1] *= inverse), ...);
  }

  /** Takes the pivot column, times a factor, off the column K further; its length is known when compiling. */
  template <int K>
  static void subtract(double* __restrict column, double factor)
  {
    double* __restrict target = column + static_cast<std::size_t>(K) * kStride;
#pragma GCC unroll 16
    for (int q = 0; q <= Bandwidth - K; ++q)
      target[q] -= factor * column[K + q];
  }

  static void eliminate(double* column, double inverse, int below)
  {
    for (int k = 1; k <= below; ++k)
    {
      const double factor = column[k] * inverse;
      double* target = column + static_cast<std::size_t>(k) * kStride;
      for (int q = 0; q <= below - k; ++q)
        target[q] -= factor * column[k + q];
    }
    for (int k = 1; k <= below; ++k)
      column[k] *= inverse;
  }

  int size_ = 0;
  std::vector<double> band_;
};

}  // namespace endovascular_sim::rod
