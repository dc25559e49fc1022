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
 *  is then the number of constraints, which checks every factorisation for free.
 *
 *  Unknowns that come in blocks of Period leave the band's corner empty: column c then ends c mod Period rows earlier.
 */
template <int Bandwidth, int Period = 1>
class BandedLdlt
{
public:
  static constexpr int kStride = Bandwidth + 1;
  static constexpr int kMarkEvery = 16 * Period;  ///< columns between the marks to which rewind() can return

  /** Sets the size and zeroes the band; allocates only when it grows. */
  void reset(int size)
  {
    resize(size);
    std::fill(band_.begin(), band_.end(), 0.0);
  }

  /** Sets the size, for a caller that sets all columns; allocates only when it grows. */
  void resize(int size)
  {
    size_ = size;
    begin_ = 0;
    band_.resize(static_cast<std::size_t>(size) * kStride);
  }

  int size() const { return size_; }

  /** Entry of the lower triangle, col ≤ row ≤ col + Bandwidth. */
  double& at(int row, int col) { return band_[static_cast<std::size_t>(col) * kStride + (row - col)]; }
  double at(int row, int col) const { return band_[static_cast<std::size_t>(col) * kStride + (row - col)]; }

  /** Lower band of a column, from its diagonal entry down; columns follow each other at kStride. */
  double* column(int col) { return band_.data() + static_cast<std::size_t>(col) * kStride; }

  /** Copies another matrix's entries; allocates only when it grows. */
  void copyFrom(const BandedLdlt& other)
  {
    size_ = other.size_;
    begin_ = 0;
    band_.assign(other.band_.begin(), other.band_.end());
  }

  /** Prepares the factorisation of a matrix that differs from the last one only in the columns from @p changed on. The
   *  factors of earlier columns stay; factorise() continues from there and gives the same bits as a whole
   * factorisation.
   *  @param other matrix from which the remaining columns are copied
   *  @return the first column copied; terms added to it and to later columns must be added again */
  int rewind(const BandedLdlt& other, int changed)
  {
    int mark = std::min((changed - kWindow) / kMarkEvery, marks_) - 1;
    if (mark < 0)
    {
      copyFrom(other);
      return 0;
    }
    begin_ = (mark + 1) * kMarkEvery;
    marks_ = mark + 1;
    negative_ = negative_before_[mark];
    std::copy_n(windows_.data() + static_cast<std::ptrdiff_t>(mark) * kWindowSize, kWindowSize, column(begin_));
    const int copied = begin_ + kWindow;
    std::copy(other.band_.begin() + static_cast<std::ptrdiff_t>(copied) * kStride, other.band_.end(), column(copied));
    return copied;
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
    int col = begin_;
    if (col == 0)
      negative_ = marks_ = 0;
    bool regular = true;
    for (; regular && col + Period + Bandwidth <= size_; col += Period)
    {
      if (col > begin_ && col % kMarkEvery == 0)
        mark(col);
      regular = eliminateBlock(col, std::make_integer_sequence<int, Period>());
    }
    for (; regular && col < size_; ++col)
      regular = eliminateShort(col);
    return regular ? negative_ : -1;
  }

  /** Solves in place with the factors. */
  void solve(std::vector<double>& rhs) const
  {
    double* x = rhs.data();
    // Sums run from the farthest entry to the nearest: only the nearest depends on the preceding row.
    int row = 0;
    for (; row < std::min(Bandwidth + Period, size_); ++row)
      forwardShort(x, row);
    while (row % Period != 0 && row < size_)
      forwardShort(x, row++);
    for (; row + Period <= size_; row += Period)
      forwardBlock(x, row, std::make_integer_sequence<int, Period>());
    for (; row < size_; ++row)
      forwardShort(x, row);
    int col = size_;
    while (col > 0 && (col % Period != 0 || col + Bandwidth > size_))
      backwardShort(x, --col);
    for (; col > 0; col -= Period)
      backwardBlock(x, col - Period, std::make_integer_sequence<int, Period>());
  }

private:
  /** Number of columns after a mark that earlier columns modify, rounded up to whole blocks. */
  static constexpr int kWindow = (Bandwidth + Period - 1) / Period * Period;
  static constexpr int kWindowSize = kWindow * kStride;

  /** Saves the columns from one on before their elimination. */
  void mark(int col)
  {
    if (col + kWindow > size_)
      return;
    windows_.resize(std::max(windows_.size(), static_cast<std::size_t>(marks_ + 1) * kWindowSize));
    negative_before_.resize(std::max(negative_before_.size(), static_cast<std::size_t>(marks_ + 1)));
    std::copy_n(column(col), kWindowSize, windows_.data() + static_cast<std::ptrdiff_t>(marks_) * kWindowSize);
    negative_before_[marks_++] = negative_;
  }

  /** Entries below the diagonal of a column at the given place in its block, rounded up to an even number: entries are
   *  processed in pairs, and the load of a pair would stall on a single stored entry. */
  static constexpr int columnLength(int place) { return Bandwidth - place + (place > 0 ? (Bandwidth - place) % 2 : 0); }
  /** Entries left of the diagonal of such a row: back to the first column whose block still reaches it. */
  static constexpr int rowLength(int place) { return place + (Bandwidth - place) / Period * Period; }

  bool isPivot(double pivot)
  {
    negative_ += pivot < 0.0;
    return pivot == pivot && pivot != 0.0;
  }

  template <int... Place>
  bool eliminateBlock(int col, std::integer_sequence<int, Place...>)
  {
    return (eliminateColumn<columnLength(Place)>(column(col + Place),
                                                 std::make_integer_sequence<int, columnLength(Place)>()) &&
            ...);
  }

  template <int Length, int... Index>
  bool eliminateColumn(double* __restrict pivot_column, std::integer_sequence<int, Index...>)
  {
    if (!isPivot(pivot_column[0]))
      return false;
    const double inverse = 1.0 / pivot_column[0];
    (subtract<Length, Index + 1>(pivot_column, pivot_column[Index + 1] * inverse), ...);
    ((pivot_column[Index + 1] *= inverse), ...);
    return true;
  }

  /** Subtracts the pivot column, times a factor, from the column K further on; the length is a compile-time constant.
   */
  template <int Length, int K>
  static void subtract(double* __restrict pivot_column, double factor)
  {
    double* __restrict target = pivot_column + static_cast<std::size_t>(K) * kStride;
#pragma GCC unroll 16
    for (int q = 0; q <= Length - K; ++q)
      target[q] -= factor * pivot_column[K + q];
  }

  bool eliminateShort(int col)
  {
    double* pivot_column = column(col);
    if (!isPivot(pivot_column[0]))
      return false;
    const double inverse = 1.0 / pivot_column[0];
    const int below = std::min(columnLength(col % Period), size_ - 1 - col);
    for (int k = 1; k <= below; ++k)
    {
      const double factor = pivot_column[k] * inverse;
      double* target = pivot_column + static_cast<std::size_t>(k) * kStride;
      for (int q = 0; q <= below - k; ++q)
        target[q] -= factor * pivot_column[k + q];
    }
    for (int k = 1; k <= below; ++k)
      pivot_column[k] *= inverse;
    return true;
  }

  template <int... Place>
  void forwardBlock(double* x, int row, std::integer_sequence<int, Place...>) const
  {
    (forward<rowLength(Place)>(x, row + Place), ...);
  }

  template <int Length>
  void forward(double* x, int row) const
  {
    const double* diagonal = band_.data() + static_cast<std::size_t>(row) * kStride;
    double sum = 0.0;
#pragma GCC unroll 16
    for (int k = Length; k >= 1; --k)
      sum += diagonal[k - k * kStride] * x[row - k];
    x[row] -= sum;
  }

  void forwardShort(double* x, int row) const
  {
    const double* diagonal = band_.data() + static_cast<std::size_t>(row) * kStride;
    double sum = 0.0;
    for (int k = std::min(rowLength(row % Period), row); k >= 1; --k)
      sum += diagonal[k - k * kStride] * x[row - k];
    x[row] -= sum;
  }

  template <int... Place>
  void backwardBlock(double* x, int col, std::integer_sequence<int, Place...>) const
  {
    (backward<columnLength(Period - 1 - Place)>(x, col + Period - 1 - Place), ...);
  }

  template <int Length>
  void backward(double* x, int col) const
  {
    const double* entry = band_.data() + static_cast<std::size_t>(col) * kStride;
    double sum = 0.0;
#pragma GCC unroll 16
    for (int k = Length; k >= 1; --k)
      sum += entry[k] * x[col + k];
    x[col] = x[col] / entry[0] - sum;
  }

  void backwardShort(double* x, int col) const
  {
    const double* entry = band_.data() + static_cast<std::size_t>(col) * kStride;
    double sum = 0.0;
    for (int k = std::min(columnLength(col % Period), size_ - 1 - col); k >= 1; --k)
      sum += entry[k] * x[col + k];
    x[col] = x[col] / entry[0] - sum;
  }

  int size_ = 0;
  int negative_ = 0;
  int begin_ = 0;  ///< column at which factorise() begins
  int marks_ = 0;
  std::vector<double> band_;
  std::vector<double> windows_;       ///< saved columns of every mark
  std::vector<int> negative_before_;  ///< negative pivots before every mark
};

}  // namespace endovascular_sim::rod
