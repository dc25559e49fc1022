#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Closed tube with flat ends, in millimetres: radius 4, length 40, normals outwards. It has 2·around·(along + 1)
 *  triangles. */
inline geometry::TriangleMesh capsule(int around, int along)
{
  geometry::TriangleMesh mesh;
  for (int row = 0; row <= along; ++row)
    for (int k = 0; k < around; ++k)
    {
      const double angle = 2.0 * M_PI * k / around;
      mesh.vertices.emplace_back(4.0 * std::cos(angle), 4.0 * std::sin(angle), 40.0 * row / along);
    }
  const int ends = (along + 1) * around;
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  mesh.vertices.emplace_back(0.0, 0.0, 40.0);
  for (int k = 0; k < around; ++k)
  {
    const int next = (k + 1) % around;
    for (int row = 0; row < along; ++row)
    {
      const int below = row * around;
      const int above = below + around;
      mesh.triangles.emplace_back(below + k, below + next, above + k);
      mesh.triangles.emplace_back(below + next, above + next, above + k);
    }
    mesh.triangles.emplace_back(next, k, ends);
    mesh.triangles.emplace_back(along * around + k, along * around + next, ends + 1);
  }
  return mesh;
}

enum class MeshFormat
{
  kObj,
  kRelativeObj,  ///< negative vertex numbers, normals
  kAsciiStl,
  kBinaryStl,
  kAsciiPly,
  kLittleEndianPly,
  kBigEndianPly
};

inline const char* nameOf(MeshFormat format)
{
  static const char* const kNames[] = {"Obj",      "RelativeObj",     "AsciiStl",    "BinaryStl",
                                       "AsciiPly", "LittleEndianPly", "BigEndianPly"};
  return kNames[static_cast<int>(format)];
}

inline const char* extensionOf(MeshFormat format)
{
  static const char* const kExtensions[] = {".obj", ".obj", ".stl", ".stl", ".ply", ".ply", ".ply"};
  return kExtensions[static_cast<int>(format)];
}

/** Appends the bytes of a number. */
template <typename Number>
void append(std::string& bytes, Number number, bool big_endian = false)
{
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  for (std::size_t k = 0; k < sizeof number; ++k)
    bytes += raw[big_endian ? sizeof number - 1 - k : k];
}

inline std::string objFile(const geometry::TriangleMesh& mesh, bool relative)
{
  std::ostringstream out;
  out.precision(9);
  const int count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices)
    out << "v " << v.transpose() << (relative ? "\nvn 0 0 1\n" : "\n");
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (relative)
      out << "f " << t[0] - count << "//1 " << t[1] - count << "//1 " << t[2] - count << "//1\n";
    else
      out << "f " << t.transpose() + Eigen::RowVector3i::Ones() << '\n';
  return out.str();
}

inline std::string asciiStlFile(const geometry::TriangleMesh& mesh)
{
  std::ostringstream out;
  out.precision(9);
  out << "solid capsule\n";
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    out << "facet normal 0 0 0\n outer loop\n";
    for (int k = 0; k < 3; ++k)
      out << "  vertex " << mesh.vertices[static_cast<std::size_t>(t[k])].transpose() << '\n';
    out << " endloop\nendfacet\n";
  }
  out << "endsolid capsule\n";
  return out.str();
}

inline std::string binaryStlFile(const geometry::TriangleMesh& mesh)
{
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    bytes.append(12, '\0');
    for (int k = 0; k < 3; ++k)
      for (const double coordinate : mesh.vertices[static_cast<std::size_t>(t[k])])
        append(bytes, static_cast<float>(coordinate));
    bytes.append(2, '\0');
  }
  return bytes;
}

inline std::string plyFile(const geometry::TriangleMesh& mesh, MeshFormat format)
{
  const bool ascii = format == MeshFormat::kAsciiPly;
  const bool big = format == MeshFormat::kBigEndianPly;
  std::ostringstream text;
  text.precision(9);
  text << "ply\nformat "
       << (ascii ? "ascii"
           : big ? "binary_big_endian"
                 : "binary_little_endian")
       << " 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  if (ascii)
  {
    for (const Eigen::Vector3d& v : mesh.vertices)
      text << v.transpose() << '\n';
    for (const Eigen::Vector3i& t : mesh.triangles)
      text << "3 " << t.transpose() << '\n';
    return text.str();
  }
  std::string bytes = text.str();
  for (const Eigen::Vector3d& v : mesh.vertices)
    for (const double coordinate : v)
      append(bytes, coordinate, big);
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    bytes += '\3';
    for (const int vertex : t)
      append(bytes, static_cast<std::int32_t>(vertex), big);
  }
  return bytes;
}

/** Content of a mesh file. */
inline std::string meshFile(const geometry::TriangleMesh& mesh, MeshFormat format)
{
  switch (format)
  {
    case MeshFormat::kObj:
      return objFile(mesh, false);
    case MeshFormat::kRelativeObj:
      return objFile(mesh, true);
    case MeshFormat::kAsciiStl:
      return asciiStlFile(mesh);
    case MeshFormat::kBinaryStl:
      return binaryStlFile(mesh);
    default:
      return plyFile(mesh, format);
  }
}

}  // namespace endovascular_sim::vessel
