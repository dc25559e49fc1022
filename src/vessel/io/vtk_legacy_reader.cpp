#include "vessel/io/vtk_legacy_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "common/error.h"
#include "vessel/io/text_cursor.h"
#include "vessel/io/vtk_values.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Words, lines and numbers of a legacy VTK file. */
class LegacyCursor
{
public:
  LegacyCursor(std::string_view bytes, const std::string& path) : rest_(bytes), size_(bytes.size()), path_(&path) {}

  std::string_view line()
  {
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    return line.substr(0, line.find('\r'));
  }

  /** Next word, in this or a later line; empty at the end. */
  std::string_view word()
  {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(word.size());
    return word;
  }

  /** Next word in upper case. */
  std::string keyword()
  {
    std::string word(this->word());
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return word;
  }

  std::size_t count()
  {
    std::size_t count = 0;
    if (!parseNumber(word(), count) || count > size_)
      refuse("needs a number of values that the file can hold; the file is damaged");
    return count;
  }

  /** Numbers of an array; those of binary files begin in the next line. */
  std::vector<double> numbers(std::size_t count, std::string_view type_name, bool binary)
  {
    if (type_name == "bit")
    {
      skipBits(count, binary);
      return {};
    }
    VtkType type;
    if (!parseVtkType(type_name, type))
      refuse("unknown type '" + std::string(type_name.substr(0, 20)) + "'");
    if (binary)
    {
      line();
      if (rest_.size() / type.size < count)
        refuse("ends before its values; the file is truncated");
      std::vector<double> values = vtkValues(rest_.substr(0, count * type.size), type, true);
      rest_.remove_prefix(count * type.size);
      return values;
    }
    if (rest_.size() / 2 + 1 < count)
      refuse("ends before its values; the file is truncated");
    std::vector<double> values(count);
    for (double& value : values)
      if (!parseNumber(word(), value))
        refuse("has a value that is not a number; the file is truncated or damaged");
    return values;
  }

  /** Skips the lines up to an empty one. */
  void skipParagraph()
  {
    line();
    while (!rest_.empty() && !line().empty())
      continue;
  }

  /** Skips the strings of an array, one per line, in binary files each with its length. */
  void skipStrings(std::size_t count, bool binary)
  {
    line();
    for (std::size_t k = 0; k < count && !rest_.empty(); ++k)
      if (binary)
        skipBinaryString();
      else
        line();
  }

  [[noreturn]] void refuse(const std::string& reason) const
  {
    throw InputError(*path_, section_.empty() ? "byte " + std::to_string(size_ - rest_.size()) : section_, reason);
  }

  void beginSection(const std::string& name) { section_ = name; }

private:
  void skipBits(std::size_t count, bool binary)
  {
    if (binary)
    {
      line();
      rest_.remove_prefix(std::min((count + 7) / 8, rest_.size()));
    }
    for (std::size_t k = 0; !binary && k < count && !rest_.empty(); ++k)
      word();
  }

  /** The two highest bits of a string's first byte give the size of its length: 8, 4, 2 or 1 byte. */
  void skipBinaryString()
  {
    const auto first = static_cast<unsigned char>(rest_.front());
    const std::size_t bytes = std::size_t{8} >> (first >> 6U);
    if (rest_.size() < bytes)
      refuse("ends inside a text; the file is truncated");
    std::uint64_t length = first & 0x3FU;
    for (std::size_t k = 1; k < bytes; ++k)
      length = length << 8U | static_cast<unsigned char>(rest_[k]);
    rest_.remove_prefix(bytes);
    rest_.remove_prefix(std::min<std::uint64_t>(length, rest_.size()));
  }

  std::string_view rest_;
  std::size_t size_;
  const std::string* path_;
  std::string section_;  ///< keyword of the present section, for errors
};

/** Sections of a legacy VTK file. */
class LegacyReader
{
public:
  LegacyReader(std::string_view bytes, const std::string& path)
    : cursor_(withoutByteOrderMark(bytes), path), path_(path)
  {
  }

  VtkPolyData read()
  {
    readHeader();
    for (std::string keyword = cursor_.keyword(); !keyword.empty(); keyword = cursor_.keyword())
    {
      cursor_.beginSection(keyword);
      readSection(keyword);
    }
    if (data_.radii.size() != data_.points.size())
      data_.radii.clear();
    return std::move(data_);
  }

private:
  void readHeader()
  {
    if (cursor_.line().substr(0, 5) != "# vtk")
      throw InputError(path_, "", "cannot be read: a legacy VTK file begins with the line '# vtk DataFile Version'");
    data_.space = cursor_.line();
    const std::string storage = cursor_.keyword();
    if (storage != "ASCII" && storage != "BINARY")
      throw InputError(path_, "line 3", "must be ASCII or BINARY; the file is damaged");
    binary_ = storage == "BINARY";
  }

  void readSection(const std::string& keyword)
  {
    if (keyword == "DATASET")
    {
      if (const std::string kind = cursor_.keyword(); kind != "POLYDATA")
        throw InputError(
            path_, "DATASET",
            "is " + kind.substr(0, 40) + "; export the surface or the centreline as polygonal data (.vtp)");
    }
    else if (keyword == "POINTS")
      readPoints();
    else if (keyword == "LINES")
      readCells(data_.lines);
    else if (keyword == "POLYGONS")
      readCells(data_.polygons);
    else if (keyword == "TRIANGLE_STRIPS")
      readCells(data_.strips);
    else if (keyword == "VERTICES")
    {
      VtkCells vertices;
      readCells(vertices);
    }
    else if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
    {
      tuples_ = cursor_.count();
      of_points_ = keyword == "POINT_DATA";
    }
    else if (keyword == "METADATA")
      cursor_.skipParagraph();
    else
      readAttributes(keyword);
  }

  void readPoints()
  {
    const std::size_t count = cursor_.count();
    const std::string type(cursor_.word());
    const std::vector<double> values = cursor_.numbers(3 * count, type, binary_);
    for (std::size_t k = 0; k < values.size(); k += 3)
      data_.points.emplace_back(values[k], values[k + 1], values[k + 2]);
  }

  long long indexOf(double value) const
  {
    if (!(std::abs(value) < 9e15) || value != std::floor(value))
      cursor_.refuse("has an index that is not an integer; the file is damaged");
    return static_cast<long long>(value);
  }

  void readCells(VtkCells& cells)
  {
    const std::size_t count = cursor_.count();
    const std::size_t size = cursor_.count();
    const LegacyCursor here = cursor_;
    if (cursor_.keyword() == "OFFSETS")
      readOffsets(count, size, cells);
    else
    {
      cursor_ = here;
      readLists(count, size, cells);
    }
  }

  /** Cells of versions up to 5.0: each its number of points and their indices. */
  void readLists(std::size_t count, std::size_t size, VtkCells& cells)
  {
    const std::vector<double> values = cursor_.numbers(size, "int", binary_);
    std::size_t at = 0;
    for (std::size_t k = 0; k < count; ++k)
    {
      const long long points = at < size ? indexOf(values[at++]) : -1;
      if (points < 0 || static_cast<unsigned long long>(points) > size - at)
        cursor_.refuse("has a cell with more points than the section; the file is damaged");
      for (long long i = 0; i < points; ++i)
        cells.points.push_back(indexOf(values[at++]));
      cells.ends.push_back(cells.points.size());
    }
  }

  /** Cells of version 5.1: offsets, the first of them 0, and indices. */
  void readOffsets(std::size_t count, std::size_t size, VtkCells& cells)
  {
    const std::string type(cursor_.word());
    const std::vector<double> offsets = cursor_.numbers(count, type, binary_);
    if (cursor_.keyword() != "CONNECTIVITY")
      cursor_.refuse("has OFFSETS without CONNECTIVITY; the file is damaged");
    const std::string index_type(cursor_.word());
    for (const double value : cursor_.numbers(size, index_type, binary_))
      cells.points.push_back(indexOf(value));
    std::size_t previous = 0;
    for (std::size_t k = 1; k < offsets.size(); ++k)
    {
      const long long offset = indexOf(offsets[k]);
      if (offset < 0 || static_cast<unsigned long long>(offset) > size || static_cast<std::size_t>(offset) < previous)
        cursor_.refuse("has an offset that no cell can have; the file is damaged");
      previous = static_cast<std::size_t>(offset);
      cells.ends.push_back(previous);
    }
  }

  /** Reads an array of point or cell data, and keeps the radii of points. */
  void readArray(const std::string& name, std::size_t components, std::size_t tuples, const std::string& type)
  {
    if (type == "string")
      return cursor_.skipStrings(components * tuples, binary_);
    if (components > 0 && tuples > std::numeric_limits<std::size_t>::max() / components)
      cursor_.refuse("has too many values; the file is damaged");
    const std::vector<double> values = cursor_.numbers(components * tuples, type, binary_);
    if (of_points_ && components == 1 && namesRadii(name))
      data_.radii = values;
  }

  void readAttributes(const std::string& keyword)
  {
    if (keyword == "FIELD")
      return readField();
    const std::string name(cursor_.word());
    if (keyword == "SCALARS")
      readScalars(name);
    else if (keyword == "COLOR_SCALARS")
      readArray(name, cursor_.count(), tuples_, binary_ ? "unsigned_char" : "float");
    else if (keyword == "LOOKUP_TABLE")
      readArray(name, 4, cursor_.count(), binary_ ? "unsigned_char" : "float");
    else if (keyword == "TEXTURE_COORDINATES")
    {
      const std::size_t components = cursor_.count();
      readArray(name, components, tuples_, std::string(cursor_.word()));
    }
    else
    {
      const bool is_id = keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS";
      const bool is_vector = keyword == "VECTORS" || keyword == "NORMALS";
      const std::size_t components = is_id                   ? 1
                                     : is_vector             ? 3
                                     : keyword == "TENSORS"  ? 9
                                     : keyword == "TENSORS6" ? 6
                                                             : 0;
      if (components == 0)
        cursor_.refuse("is no section of a legacy VTK file; the file is damaged");
      readArray(name, components, tuples_, std::string(cursor_.word()));
    }
  }

  void readScalars(const std::string& name)
  {
    const std::string type(cursor_.word());
    TextCursor rest(cursor_.line());
    std::size_t components = 1;
    if (rest.nextLine())
      parseNumber(rest.word(), components);
    if (cursor_.keyword() != "LOOKUP_TABLE")
      cursor_.refuse("has no LOOKUP_TABLE; the file is damaged");
    cursor_.word();
    readArray(name, components, tuples_, type);
  }

  void readField()
  {
    cursor_.word();
    const std::size_t arrays = cursor_.count();
    for (std::size_t k = 0; k < arrays; ++k)
    {
      std::string name(cursor_.word());
      if (name == "METADATA")
      {
        cursor_.skipParagraph();
        name = cursor_.word();
      }
      if (name.empty())
        return;
      const std::size_t components = cursor_.count();
      const std::size_t tuples = cursor_.count();
      readArray(name, components, tuples, std::string(cursor_.word()));
    }
  }

  LegacyCursor cursor_;
  const std::string& path_;
  bool binary_ = false;
  bool of_points_ = false;  ///< true in point data
  std::size_t tuples_ = 0;  ///< number of points or cells of the present data
  VtkPolyData data_;
};

}  // namespace

VtkPolyData readLegacyVtk(std::string_view bytes, const std::string& path)
{
  return LegacyReader(bytes, path).read();
}

}  // namespace endovascular_sim::vessel
