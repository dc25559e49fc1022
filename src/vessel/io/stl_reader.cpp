#include "vessel/io/stl_reader.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "common/error.h"
#include "vessel/io/text_cursor.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kHeader = 80;          // bytes before the number of triangles
constexpr std::size_t kFacet = 50;           // bytes of a triangle: normal, three corners, attribute
constexpr std::size_t kMostSurplus = 65536;  // bytes after the triangles: colours, a line end, a padded block

std::string lowerCase(std::string_view word)
{
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/** True for a text that begins with `solid`, in any case, after blanks. Binary headers may begin so too. */
bool isAscii(std::string_view bytes)
{
  const std::string_view text = withoutByteOrderMark(bytes);
  const std::size_t begin = text.find_first_not_of(" \t\r\n\v\f");
  return begin != std::string_view::npos && lowerCase(text.substr(begin, 5)) == "solid" &&
         text.find('\0') == std::string_view::npos;
}

template <typename Value>
Value littleEndian(std::string_view bytes, std::size_t at)
{
  static_assert(sizeof(Value) == 4);
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < 4; ++k)
    bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  Value value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::size_t facetsByHeader(std::string_view bytes)
{
  return bytes.size() < kHeader + 4 ? 0 : littleEndian<std::uint32_t>(bytes, kHeader);
}

void addFacet(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, std::size_t line,
              MeshBuilder& mesh)
{
  const auto first = static_cast<long long>(mesh.vertices());
  mesh.addVertex(a, line);
  mesh.addVertex(b, line);
  mesh.addVertex(c, line);
  mesh.addFace({first, first + 1, first + 2}, line);
}

void readBinary(std::string_view bytes, MeshBuilder& mesh)
{
  const std::size_t facets = facetsByHeader(bytes);
  mesh.readSpace(bytes.substr(0, kHeader));
  for (std::size_t f = 0; f < facets; ++f)
  {
    const std::size_t begin = kHeader + 4 + f * kFacet + 12;
    Eigen::Vector3d corner[3];
    for (std::size_t k = 0; k < 9; ++k)
      corner[k / 3][static_cast<Eigen::Index>(k % 3)] = littleEndian<float>(bytes, begin + 4 * k);
    addFacet(corner[0], corner[1], corner[2], 0, mesh);
    mesh.reportRest(bytes.size() - begin);
  }
}

/** Statements of an ASCII STL text. */
class AsciiReader
{
public:
  AsciiReader(std::string_view text, const std::string& path, MeshBuilder& mesh)
    : cursor_(text), path_(path), mesh_(mesh)
  {
  }

  void read()
  {
    while (cursor_.nextLine())
    {
      const std::string_view line = cursor_.restOfLine();
      const std::string keyword = lowerCase(cursor_.word());
      if (keyword == "solid")
        mesh_.readSpace(line);
      readStatement(keyword);
      mesh_.reportRest(cursor_.restOfText().size());
    }
    if (in_loop_ || !ended_)
      throw InputError(path_, "", "has no endsolid; the file is truncated");
  }

private:
  [[noreturn]] void refuse(const std::string& reason) const
  {
    throw InputError(path_, "line " + std::to_string(cursor_.lineNumber()), reason);
  }

  void readStatement(std::string_view keyword)
  {
    if (keyword == "vertex")
      readVertex();
    else if (keyword == "outer")
    {
      if (in_loop_)
        refuse("a loop begins before the previous one has ended");
      in_loop_ = true;
      corners_.clear();
    }
    else if (keyword == "endloop")
    {
      if (!in_loop_ || corners_.size() != 3)
        refuse("a facet of an STL file has exactly three vertices");
      addFacet(corners_[0], corners_[1], corners_[2], cursor_.lineNumber(), mesh_);
      in_loop_ = false;
    }
    else if (keyword == "solid" || keyword == "endsolid")
      ended_ = keyword == "endsolid";
    else if (!keyword.empty() && keyword != "facet" && keyword != "endfacet")
      refuse("is no statement of an ASCII STL file; the file is damaged");
  }

  void readVertex()
  {
    Eigen::Vector3d position;
    for (int k = 0; k < 3; ++k)
      if (!parseNumber(cursor_.word(), position[k]))
        refuse("a vertex needs three numbers");
    if (!in_loop_ || corners_.size() == 3 || !cursor_.word().empty())
      refuse("a facet of an STL file has exactly three vertices, each of three numbers");
    corners_.push_back(position);
  }

  TextCursor cursor_;
  const std::string& path_;
  MeshBuilder& mesh_;
  std::vector<Eigen::Vector3d> corners_;  ///< of the present loop
  bool in_loop_ = false;
  bool ended_ = false;
};

}  // namespace

void readStl(std::string_view bytes, const std::string& path, MeshBuilder& mesh)
{
  const std::size_t facets = facetsByHeader(bytes);
  const std::size_t size = kHeader + 4 + facets * kFacet;
  const bool has_facets = facets > 0 && bytes.size() >= size && bytes.size() - size <= kMostSurplus;
  if (has_facets && bytes.size() == size)
    readBinary(bytes, mesh);
  else if (isAscii(bytes))
    AsciiReader(withoutByteOrderMark(bytes), path, mesh).read();
  else if (has_facets)
  {
    readBinary(bytes, mesh);
    mesh.warn("has " + std::to_string(bytes.size() - size) + (bytes.size() - size == 1 ? " byte" : " bytes") +
              " after its " + std::to_string(facets) + " triangles; they are ignored");
  }
  else if (bytes.size() < kHeader + 4)
    throw InputError(path, "", "cannot be read as a mesh: it is neither a binary nor an ASCII STL file");
  else if (facets == 0)
    throw InputError(path, "",
                     "cannot be read as a mesh: the header says 0 facets, but " +
                         std::to_string(bytes.size() - kHeader - 4) + " bytes follow, room for " +
                         std::to_string((bytes.size() - kHeader - 4) / kFacet) +
                         "; the program that wrote it did not fill in their number: export the mesh again");
  else
    throw InputError(path, "",
                     "cannot be read as a mesh: a binary STL file of " + std::to_string(facets) + " triangles has " +
                         std::to_string(size) + " bytes, this file " + std::to_string(bytes.size()) + "; it is " +
                         (bytes.size() < size ? "truncated" : "damaged"));
}

}  // namespace endovascular_sim::vessel
