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
  }
}

void readAscii(std::string_view text, const std::string& path, MeshBuilder& mesh)
{
  TextCursor cursor(text);
  std::vector<Eigen::Vector3d> corners;
  bool in_loop = false;
  while (cursor.nextLine())
  {
    const std::string_view keyword = cursor.word();
    const std::string line = "line " + std::to_string(cursor.lineNumber());
    if (keyword == "outer")
    {
      if (in_loop)
        throw InputError(path, line, "a loop begins before the previous one has ended");
      in_loop = true;
      corners.clear();
    }
    else if (keyword == "vertex")
    {
      Eigen::Vector3d position;
      for (int k = 0; k < 3; ++k)
        if (!parseNumber(cursor.word(), position[k]))
          throw InputError(path, line, "a vertex needs three numbers");
      if (!in_loop || corners.size() == 3)
        throw InputError(path, line, "a facet of an STL file has exactly three vertices");
      corners.push_back(position);
    }
    else if (keyword == "endloop")
    {
      if (!in_loop || corners.size() != 3)
        throw InputError(path, line, "a facet of an STL file has exactly three vertices");
      addFacet(corners[0], corners[1], corners[2], cursor.lineNumber(), mesh);
      in_loop = false;
    }
    else if (!keyword.empty() && keyword != "solid" && keyword != "facet" && keyword != "endfacet" &&
             keyword != "endsolid")
      throw InputError(path, line, "is no statement of an ASCII STL file; the file is damaged");
  }
  if (in_loop)
    throw InputError(path, "", "ends within a facet; the file is truncated");
}

}  // namespace

void readStl(std::string_view bytes, const std::string& path, MeshBuilder& mesh)
{
  const std::size_t facets = facetsByHeader(bytes);
  if (facets > 0 && bytes.size() == kHeader + 4 + facets * kFacet)
    readBinary(bytes, mesh);
  else if (bytes.substr(0, 5) == "solid" && bytes.find('\0') == std::string_view::npos)
    readAscii(bytes, path, mesh);
  else if (bytes.size() >= kHeader + 4)
    throw InputError(path, "",
                     "cannot be read as a mesh: a binary STL file of " + std::to_string(facets) + " triangles has " +
                         std::to_string(kHeader + 4 + facets * kFacet) + " bytes, this file " +
                         std::to_string(bytes.size()) + "; it is truncated or damaged");
  else
    throw InputError(path, "", "cannot be read as a mesh: it is neither a binary nor an ASCII STL file");
}

}  // namespace endovascular_sim::vessel
