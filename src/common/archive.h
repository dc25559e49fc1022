#pragma once

#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim
{

/** A saved state that ends too early or says what cannot be. */
class ArchiveError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** Bytes of a state, written or read by the same calls in the same order: a class says once what it consists of.
 *  Numbers keep their bits; byte order is the machine's. */
class Archive
{
public:
  Archive() = default;                                                             ///< to be written
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reads_(true) {}  ///< to be read

  bool reading() const { return reads_; }
  const std::string& bytes() const { return bytes_; }
  bool atEnd() const { return at_ == bytes_.size(); }  ///< all was read

  template <typename... Values>
  void operator()(Values&... values)
  {
    (add(values), ...);
  }

private:
  template <typename T>
  std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>> add(T& value)
  {
    raw(&value, sizeof value);
  }

  template <typename T, int kRows>
  void add(Eigen::Matrix<T, kRows, 1>& vector)
  {
    static_assert(kRows > 0, "of a fixed size");
    raw(vector.data(), sizeof(T) * kRows);
  }

  template <typename T>
  void add(std::vector<T>& values)
  {
    const std::size_t size = resized(values);
    for (std::size_t k = 0; k < size; ++k)
      add(values[k]);
  }

  template <typename T>
  void add(std::deque<T>& values)
  {
    const std::size_t size = resized(values);
    for (std::size_t k = 0; k < size; ++k)
      add(values[k]);
  }

  template <typename T>
  void add(std::optional<T>& value)
  {
    bool there = value.has_value();
    add(there);
    if (reads_ && there && !value)
      value.emplace();
    if (reads_ && !there)
      value.reset();
    if (there)
      add(*value);
  }

  /** Whatever says itself what it consists of: a member or a free function archive(). */
  template <typename T>
  std::enable_if_t<std::is_class_v<T>> add(T& value)
  {
    archiveOf(value, 0);
  }

  template <typename T>
  auto archiveOf(T& value, int /*preferred*/) -> decltype(value.archive(*this))
  {
    value.archive(*this);
  }

  template <typename T>
  void archiveOf(T& value, long /*otherwise*/)
  {
    archive(*this, value);
  }

  template <typename Container>
  std::size_t resized(Container& values)
  {
    std::uint64_t size = values.size();
    add(size);
    // Every element takes a byte at least: a wrong number does not make one ask for all memory.
    if (reads_ && size > bytes_.size() - at_)
      throw ArchiveError("ends too early");
    if (reads_)
      values.resize(static_cast<std::size_t>(size));
    return values.size();
  }

  void raw(void* data, std::size_t size)
  {
    if (!reads_)
    {
      bytes_.append(static_cast<const char*>(data), size);
      return;
    }
    if (size > bytes_.size() - at_)
      throw ArchiveError("ends too early");
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }

  std::string bytes_;
  std::size_t at_ = 0;
  bool reads_ = false;
};

}  // namespace endovascular_sim
