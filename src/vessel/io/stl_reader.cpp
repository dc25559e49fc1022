#include "vessel/io/stl_reader.h"

#include <cstdint>
#include <cstring>
#include <vector>

#include "common/error.h"
#include "vessel/io/text_cursor.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kHeader = 80;  // bytes before the number of triangles
constexpr std::size_t kFacet = 50;   // bytes of a triangle: normal, three corners, attribute

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
      readStatement(cursor_.word());
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
  if (facets > 0 && bytes.size() == kHeader + 4 + facets * kFacet)
    readBinary(bytes, mesh);
  else if (bytes.substr(0, 5) == "solid" && bytes.find('\0') == std::string_view::npos)
    AsciiReader(bytes, path, mesh).read();
  else if (bytes.size() >= kHeader + 4)
    throw InputError(path, "",
                     "cannot be read as a mesh: a binary STL file of " + std::to_string(facets) + " triangles has " +
                         std::to_string(kHeader + 4 + facets * kFacet) + " bytes, this file " +
                         std::to_string(bytes.size()) + "; it is truncated or damaged");
  else
    throw InputError(path, "", "cannot be read as a mesh: it is neither a binary nor an ASCII STL file");
}

}  // namespace endovascular_sim::vessel
