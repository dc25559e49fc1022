#pragma once

#include <zlib.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"
#include "test/vessel/io/mesh_files.h"

namespace endovascular_sim::vessel
{

/** Storage of the arrays of a VTK file. */
enum class VtkStorage
{
  kAscii,
  kBase64,
  kBase64Zlib,
  kRaw,
  kRawZlib,
  kAppendedBase64,
  kAppendedBase64Zlib,
  kWideBigEndianRawZlib,  ///< 64-bit lengths
  kLegacyAscii,
  kLegacyBinary,
  kLegacyAsciiOffsets,  ///< version 5.1
  kLegacyBinaryOffsets,
};

inline const std::vector<VtkStorage> kVtkStorages{VtkStorage::kAscii,
                                                  VtkStorage::kBase64,
                                                  VtkStorage::kBase64Zlib,
                                                  VtkStorage::kRaw,
                                                  VtkStorage::kRawZlib,
                                                  VtkStorage::kAppendedBase64,
                                                  VtkStorage::kAppendedBase64Zlib,
                                                  VtkStorage::kWideBigEndianRawZlib,
                                                  VtkStorage::kLegacyAscii,
                                                  VtkStorage::kLegacyBinary,
                                                  VtkStorage::kLegacyAsciiOffsets,
                                                  VtkStorage::kLegacyBinaryOffsets};

inline bool isLegacy(VtkStorage storage)
{
  return storage >= VtkStorage::kLegacyAscii;
}

inline const char* extensionOf(VtkStorage storage)
{
  return isLegacy(storage) ? ".vtk" : ".vtp";
}

inline const char* nameOf(VtkStorage storage)
{
  static const char* const kNames[] = {"Ascii",       "Base64",         "Base64Zlib",         "Raw",
                                       "RawZlib",     "AppendedBase64", "AppendedBase64Zlib", "WideBigEndianRawZlib",
                                       "LegacyAscii", "LegacyBinary",   "LegacyAsciiOffsets", "LegacyBinaryOffsets"};
  return kNames[static_cast<int>(storage)];
}

/** Content of a VTK file: points with optional radii, and cells of each kind. */
struct VtkContent
{
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> lines;
  std::vector<std::vector<int>> strips;
  std::vector<std::vector<int>> polygons;
  std::vector<double> radii;
  std::string space;  ///< LPS, RAS, or empty
};

inline VtkContent surfaceContent(const geometry::TriangleMesh& mesh)
{
  VtkContent content;
  content.points.assign(mesh.vertices.begin(), mesh.vertices.end());
  for (const Eigen::Vector3i& t : mesh.triangles)
    content.polygons.push_back({t[0], t[1], t[2]});
  return content;
}

inline std::string base64(const std::string& bytes)
{
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3)
  {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i)
      bits = bits << 8U | (k + i < bytes.size() ? static_cast<unsigned char>(bytes[k + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      text += k + i > bytes.size() && i > 1 ? '=' : kDigits[bits >> (18 - 6 * i) & 63U];
  }
  return text;
}

/** Writer of a VTP file. */
class VtpWriter
{
public:
  explicit VtpWriter(VtkStorage storage) : storage_(storage) {}

  std::string file(const VtkContent& content)
  {
    std::ostringstream out;
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\""
        << (isBig() ? "BigEndian" : "LittleEndian") << "\" header_type=\"" << (isBig() ? "UInt64" : "UInt32") << "\""
        << (isCompressed() ? " compressor=\"vtkZLibDataCompressor\"" : "") << ">\n<PolyData>\n";
    if (!content.space.empty())
      out << "<FieldData><Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">"
          << spaceCodes(content.space) << "</Array></FieldData>\n";
    out << "<Piece NumberOfPoints=\"" << content.points.size() << "\" NumberOfLines=\"" << content.lines.size()
        << "\" NumberOfStrips=\"" << content.strips.size() << "\" NumberOfPolys=\"" << content.polygons.size()
        << "\">\n";
    if (!content.radii.empty())
      out << "<PointData Scalars=\"MaximumInscribedSphereRadius\">\n"
          << array("Float64", "MaximumInscribedSphereRadius", content.radii) << "</PointData>\n";
    std::vector<double> coordinates;
    for (const Eigen::Vector3d& p : content.points)
      coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
    out << "<Points>\n" << array("Float64", "Points", coordinates) << "</Points>\n<Verts></Verts>\n";
    cells(out, "Lines", content.lines);
    cells(out, "Strips", content.strips);
    cells(out, "Polys", content.polygons);
    out << "</Piece>\n</PolyData>\n";
    if (isAppended())
      out << "<AppendedData encoding=\"" << (isBase64() ? "base64" : "raw") << "\">\n   _" << appended_
          << "\n  </AppendedData>\n";
    out << "</VTKFile>\n";
    return out.str();
  }

private:
  bool isBig() const { return storage_ == VtkStorage::kWideBigEndianRawZlib; }
  bool isAppended() const { return storage_ >= VtkStorage::kRaw; }
  bool isBase64() const
  {
    return storage_ == VtkStorage::kBase64 || storage_ == VtkStorage::kBase64Zlib ||
           storage_ == VtkStorage::kAppendedBase64 || storage_ == VtkStorage::kAppendedBase64Zlib;
  }
  bool isCompressed() const
  {
    return storage_ == VtkStorage::kBase64Zlib || storage_ == VtkStorage::kRawZlib ||
           storage_ == VtkStorage::kAppendedBase64Zlib || isBig();
  }

  static std::string spaceCodes(const std::string& space)
  {
    std::string codes;
    for (const char c : space)
      codes += std::to_string(static_cast<int>(c)) + " ";
    return codes + "0";
  }

  void length(std::string& bytes, std::size_t value) const
  {
    if (isBig())
      append(bytes, static_cast<std::uint64_t>(value), true);
    else
      append(bytes, static_cast<std::uint32_t>(value));
  }

  /** Blocks of at most 1000 bytes. */
  std::string block(const std::string& bytes) const
  {
    std::string header;
    if (!isCompressed())
    {
      length(header, bytes.size());
      return isBase64() ? base64(header + bytes) : header + bytes;
    }
    const std::size_t blocks = (bytes.size() + 999) / 1000;
    length(header, blocks);
    length(header, 1000);
    length(header, bytes.size() % 1000);
    std::string packed;
    for (std::size_t k = 0; k < blocks; ++k)
    {
      const std::string plain = bytes.substr(1000 * k, 1000);
      std::string made(compressBound(plain.size()), '\0');
      uLongf size = made.size();
      compress(reinterpret_cast<Bytef*>(made.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
               plain.size());
      packed.append(made, 0, size);
      length(header, size);
    }
    return isBase64() ? base64(header) + base64(packed) : header + packed;
  }

  std::string array(const std::string& type, const std::string& name, const std::vector<double>& values)
  {
    std::ostringstream out;
    out.precision(17);
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << (name == "Points" ? 3 : 1) << "\" format=\"";
    std::string bytes;
    for (const double value : values)
      if (type == "Float64")
        append(bytes, value, isBig());
      else
        append(bytes, static_cast<std::int64_t>(value), isBig());
    if (isAppended())
    {
      out << "appended\" offset=\"" << appended_.size() << "\"/>\n";
      appended_ += block(bytes);
      return out.str();
    }
    out << (storage_ == VtkStorage::kAscii ? "ascii\">\n" : "binary\">\n");
    if (storage_ == VtkStorage::kAscii)
      for (const double value : values)
        out << value << ' ';
    else
      out << "  " << block(bytes);
    out << "\n</DataArray>\n";
    return out.str();
  }

  void cells(std::ostringstream& out, const std::string& name, const std::vector<std::vector<int>>& cells)
  {
    std::vector<double> points;
    std::vector<double> offsets;
    for (const std::vector<int>& cell : cells)
    {
      points.insert(points.end(), cell.begin(), cell.end());
      offsets.push_back(static_cast<double>(points.size()));
    }
    out << '<' << name << ">\n"
        << array("Int64", "connectivity", points) << array("Int64", "offsets", offsets) << "</" << name << ">\n";
  }

  VtkStorage storage_;
  std::string appended_;
};

/** Writer of a legacy VTK file. */
class LegacyWriter
{
public:
  explicit LegacyWriter(VtkStorage storage)
    : binary_(storage == VtkStorage::kLegacyBinary || storage == VtkStorage::kLegacyBinaryOffsets),
      offsets_(storage >= VtkStorage::kLegacyAsciiOffsets)
  {
  }

  std::string file(const VtkContent& content)
  {
    text_ = std::string("# vtk DataFile Version ") + (offsets_ ? "5.1" : "4.2") + "\n3D Slicer output." +
            (content.space.empty() ? "" : " SPACE=" + content.space) + "\n" + (binary_ ? "BINARY" : "ASCII") +
            "\nDATASET POLYDATA\nPOINTS " + std::to_string(content.points.size()) + " double\n";
    for (const Eigen::Vector3d& p : content.points)
      for (const double coordinate : p)
        number(coordinate);
    text_ += "\nMETADATA\nINFORMATION 0\n\n";
    cells("LINES", content.lines);
    cells("TRIANGLE_STRIPS", content.strips);
    cells("POLYGONS", content.polygons);
    text_ += "CELL_DATA 1\nSCALARS Group int\nLOOKUP_TABLE default\n";
    index(1);
    if (content.radii.empty())
      return text_ + "\n";
    const std::string count = std::to_string(content.radii.size());
    text_ += "\nPOINT_DATA " + count + "\nFIELD FieldData 1\nMaximumInscribedSphereRadius 1 " + count + " double\n";
    for (const double radius : content.radii)
      number(radius);
    return text_ + "\n";
  }

private:
  void number(double value)
  {
    if (binary_)
      return append(text_, value, true);
    std::ostringstream out;
    out.precision(17);
    out << value << ' ';
    text_ += out.str();
  }

  void index(int value)
  {
    if (!binary_)
      text_ += std::to_string(value) + " ";
    else if (wide_)
      append(text_, static_cast<std::int64_t>(value), true);
    else
      append(text_, static_cast<std::int32_t>(value), true);
  }

  void cells(const std::string& name, const std::vector<std::vector<int>>& cells)
  {
    if (cells.empty())
      return;
    std::size_t points = 0;
    for (const std::vector<int>& cell : cells)
      points += cell.size();
    const std::size_t first = cells.size() + (offsets_ ? 1 : 0);
    text_ +=
        name + " " + std::to_string(first) + " " + std::to_string(offsets_ ? points : points + cells.size()) + "\n";
    wide_ = offsets_;
    int end = 0;
    if (offsets_)
    {
      text_ += "OFFSETS vtktypeint64\n";
      index(0);
      for (const std::vector<int>& cell : cells)
        index(end += static_cast<int>(cell.size()));
      text_ += "\nCONNECTIVITY vtktypeint64\n";
    }
    for (const std::vector<int>& cell : cells)
    {
      if (!offsets_)
        index(static_cast<int>(cell.size()));
      for (const int point : cell)
        index(point);
    }
    text_ += "\n";
    wide_ = false;
  }

  bool binary_;
  bool offsets_;
  bool wide_ = false;  ///< indices of 64 bits
  std::string text_;
};

/** Content of a VTK file of a storage. */
inline std::string vtkFile(const VtkContent& content, VtkStorage storage)
{
  return isLegacy(storage) ? LegacyWriter(storage).file(content) : VtpWriter(storage).file(content);
}

}  // namespace endovascular_sim::vessel
