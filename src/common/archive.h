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

/** Error: a saved state is truncated or holds an invalid value. */
class ArchiveError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** Binary archive of a simulation state, for both directions.
 *
 *  Writing and reading use the same calls in the same order, so each class lists its members once. Numbers keep their
 *  bits. The byte order is that of the machine. */
class Archive
{
public:
  /** Creates an empty archive for writing. */
  Archive() = default;
  /** Creates an archive that reads @p bytes. */
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reads_(true) {}

  bool reading() const { return reads_; }
  const std::string& bytes() const { return bytes_; }
  /** True if every byte has been read. */
  bool atEnd() const { return at_ == bytes_.size(); }
  /** Skips the bytes that have not been read, the data of another reader. */
  void skipRest() { at_ = bytes_.size(); }

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

  void add(bool& value)
  {
    std::uint8_t byte = !reads_ && value ? 1 : 0;
    raw(&byte, sizeof byte);
    if (byte > 1)
      throw ArchiveError("holds an invalid value");
    value = byte == 1;
  }

  void add(std::string& bytes)
  {
    const std::size_t size = resized(bytes);
    raw(bytes.data(), size);
  }

  template <typename T, int kRows>
  void add(Eigen::Matrix<T, kRows, 1>& vector)
  {
    static_assert(kRows > 0, "only vectors of fixed size are archived");
    raw(vector.data(), sizeof(T) * kRows);
  }

  template <typename T>
  void add(std::vector<T>& values)
  {
    const std::size_t size = resized(values);
    if constexpr (std::is_arithmetic_v<T>)
    {
      if (size > 0)
        raw(values.data(), size * sizeof(T));  // one block, with the bytes of the single numbers
    }
    else
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
    bool has_value = value.has_value();
    add(has_value);
    if (reads_ && has_value && !value)
      value.emplace();
    if (reads_ && !has_value)
      value.reset();
    if (has_value)
      add(*value);
  }

  /** Adds an object of class type through its member function archive(), or else through a free function archive(). */
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
    // Each element takes at least one byte. The check bounds the allocation for a corrupt size.
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
  std::size_t at_ = 0;  ///< read position [bytes]
  bool reads_ = false;
};

}  // namespace endovascular_sim
