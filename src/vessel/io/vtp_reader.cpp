#include "vessel/io/vtp_reader.h"

#include <tinyxml.h>

#include <cmath>
#include <limits>

#include "common/error.h"
#include "common/xml/xml_depth.h"
#include "vessel/io/text_cursor.h"
#include "vessel/io/vtk_values.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kMostBytes = std::size_t{1} << 30U;  // of all arrays after decoding

std::string attribute(const TiXmlElement& element, const char* name)
{
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

/** Reader of the arrays of a VTP file. */
class VtpReader
{
public:
  VtpReader(std::string_view bytes, const std::string& path) : path_(path) { parse(bytes); }

  VtkPolyData read()
  {
    const TiXmlElement* root = document_.RootElement();
    if (root == nullptr || root->ValueStr() != "VTKFile")
      throw InputError(path_, "", "cannot be read: it has no element <VTKFile>");
    if (attribute(*root, "type") != "PolyData")
      throw InputError(path_, "",
                       "holds " + (attribute(*root, "type").empty() ? "no PolyData" : attribute(*root, "type")) +
                           "; export the surface or the centreline as PolyData (.vtp)");
    readLayout(*root);
    const TiXmlElement* data = root->FirstChildElement("PolyData");
    if (data == nullptr)
      throw InputError(path_, "", "has no element <PolyData>; the file is damaged");
    readSpace(data->FirstChildElement("FieldData"));
    readSpace(root->FirstChildElement("FieldData"));
    for (const TiXmlElement* piece = data->FirstChildElement("Piece"); piece != nullptr;
         piece = piece->NextSiblingElement("Piece"))
      readPiece(*piece);
    if (has_radii_ && data_.radii.size() != data_.points.size())
      data_.radii.clear();
    return std::move(data_);
  }

private:
  /** Parses the XML, with the appended data cut out: they may be binary. */
  void parse(std::string_view bytes)
  {
    const std::size_t begin = bytes.find("<AppendedData");
    const std::size_t tag = begin == std::string_view::npos ? begin : bytes.find('>', begin);
    std::string text(bytes.substr(0, tag == std::string_view::npos ? tag : tag + 1));
    if (tag != std::string_view::npos)
    {
      text += "</AppendedData></VTKFile>";
      const std::size_t mark = bytes.find('_', tag);
      appended_ = mark == std::string_view::npos ? std::string_view() : bytes.substr(mark + 1);
    }
    requireShallowXml(text, path_);
    document_.Parse(text.c_str());
    if (document_.Error())
      throw InputError(path_, "line " + std::to_string(document_.ErrorRow()),
                       "is no XML: " + std::string(document_.ErrorDesc()) + "; the file is damaged");
  }

  void readLayout(const TiXmlElement& root)
  {
    layout_.big_endian = attribute(root, "byte_order") == "BigEndian";
    layout_.wide_headers = attribute(root, "header_type") == "UInt64";
    const std::string compressor = attribute(root, "compressor");
    layout_.compressed = !compressor.empty();
    if (layout_.compressed && compressor != "vtkZLibDataCompressor")
      throw InputError(path_, "", "is compressed by " + compressor + "; write it with zlib or without compression");
    if (const TiXmlElement* appended = root.FirstChildElement("AppendedData"))
    {
      appended_base64_ = attribute(*appended, "encoding") != "raw";
      if (appended_base64_)
        appended_ = appended_.substr(0, appended_.find('<'));
    }
  }

  [[noreturn]] void refuse(const TiXmlElement& array, const std::string& reason) const
  {
    throw InputError(path_, "array " + attribute(array, "Name") + " (line " + std::to_string(array.Row()) + ")",
                     reason);
  }

  /** Bytes of an array that is not ASCII. */
  std::string bytesOf(const TiXmlElement& array)
  {
    VtkBlocks blocks = layout_;
    std::string_view data;
    if (attribute(array, "format") == "appended")
    {
      std::size_t offset = 0;
      if (!parseNumber(attribute(array, "offset"), offset) || offset > appended_.size())
        refuse(array, "has an offset beyond the file; it is truncated or damaged");
      blocks.base64 = appended_base64_;
      data = appended_.substr(offset);
    }
    else
    {
      blocks.base64 = true;
      const char* text = array.GetText();
      data = text == nullptr ? "" : text;
      data.remove_prefix(std::min(data.find_first_not_of(" \t\r\n"), data.size()));
    }
    return data.empty() ? "" : decodeVtkBlock(data, blocks, budget_, path_);
  }

  std::vector<double> numbersOf(const TiXmlElement& array)
  {
    VtkType type;
    if (!parseVtkType(attribute(array, "type"), type))
      refuse(array, "has the unknown type '" + attribute(array, "type") + "'");
    if (attribute(array, "format") != "ascii")
      return vtkValues(bytesOf(array), type, layout_.big_endian);
    std::vector<double> values;
    const char* text = array.GetText();
    for (TextCursor cursor(text == nullptr ? "" : text); cursor.nextLine();)
      for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word())
        if (!parseNumber(word, values.emplace_back()))
          refuse(array, "'" + std::string(word.substr(0, 20)) + "' is not a number");
    return values;
  }

  /** Reads 3D Slicer's field SPACE: a string, as codes of its characters, or as bytes. */
  void readSpace(const TiXmlElement* fields)
  {
    for (const TiXmlElement* array = fields == nullptr ? nullptr : fields->FirstChildElement(); array != nullptr;
         array = array->NextSiblingElement())
    {
      if (attribute(*array, "Name") != "SPACE")
        continue;
      std::string name;
      if (attribute(*array, "format") != "ascii")
        name = bytesOf(*array);
      else if (const char* text = array->GetText(); text != nullptr)
        for (TextCursor cursor(text); cursor.nextLine();)
          for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word())
            if (int code = 0; parseNumber(word, code) && code > 0 && code < 128)
              name += static_cast<char>(code);
      data_.space = "SPACE=" + name;
    }
  }

  static const TiXmlElement* arrayNamed(const TiXmlElement* parent, const std::string& name)
  {
    for (const TiXmlElement* array = parent == nullptr ? nullptr : parent->FirstChildElement("DataArray");
         array != nullptr; array = array->NextSiblingElement("DataArray"))
      if (name.empty() || attribute(*array, "Name") == name)
        return array;
    return nullptr;
  }

  long long indexOf(const TiXmlElement& array, double value) const
  {
    if (!(std::abs(value) < 9e15) || value != std::floor(value))
      refuse(array, "has an index that is not an integer; the file is damaged");
    return static_cast<long long>(value);
  }

  void readCells(const TiXmlElement* parent, long long first_point, VtkCells& cells)
  {
    const TiXmlElement* connectivity = arrayNamed(parent, "connectivity");
    const TiXmlElement* offsets = arrayNamed(parent, "offsets");
    if (connectivity == nullptr || offsets == nullptr)
      return;
    const std::size_t begin = cells.points.size();
    for (const double value : numbersOf(*connectivity))
    {
      const long long index = indexOf(*connectivity, value);
      cells.points.push_back(index < 0 ? index : index + first_point);
    }
    std::size_t previous = begin;
    for (const double value : numbersOf(*offsets))
    {
      const long long offset = indexOf(*offsets, value);
      if (offset < 0 || static_cast<unsigned long long>(offset) > cells.points.size() - begin ||
          begin + static_cast<std::size_t>(offset) < previous)
        refuse(*offsets, "has an offset that no cell can have; the file is damaged");
      previous = begin + static_cast<std::size_t>(offset);
      cells.ends.push_back(previous);
    }
    cells.points.resize(previous);
  }

  void readPiece(const TiXmlElement& piece)
  {
    const auto first = static_cast<long long>(data_.points.size());
    const TiXmlElement* points = arrayNamed(piece.FirstChildElement("Points"), "");
    if (points == nullptr)
      return;
    const std::vector<double> values = numbersOf(*points);
    if (values.size() % 3 != 0)
      refuse(*points, "has " + std::to_string(values.size()) + " coordinates, which is no multiple of three");
    std::size_t count = 0;
    if (parseNumber(attribute(piece, "NumberOfPoints"), count) && count != values.size() / 3)
      refuse(*points, "has " + std::to_string(values.size() / 3) + " points, but the piece announces " +
                          std::to_string(count) + "; the file is truncated or damaged");
    for (std::size_t k = 0; k < values.size(); k += 3)
      data_.points.emplace_back(values[k], values[k + 1], values[k + 2]);
    readCells(piece.FirstChildElement("Lines"), first, data_.lines);
    readCells(piece.FirstChildElement("Strips"), first, data_.strips);
    readCells(piece.FirstChildElement("Polys"), first, data_.polygons);
    readRadii(piece.FirstChildElement("PointData"));
  }

  void readRadii(const TiXmlElement* point_data)
  {
    for (const TiXmlElement* array = arrayNamed(point_data, ""); array != nullptr;
         array = array->NextSiblingElement("DataArray"))
      if (namesRadii(attribute(*array, "Name")))
      {
        const std::vector<double> radii = numbersOf(*array);
        data_.radii.insert(data_.radii.end(), radii.begin(), radii.end());
        has_radii_ = true;
        return;
      }
  }

  const std::string& path_;
  TiXmlDocument document_;
  std::string_view appended_;  ///< data after the mark `_`
  bool appended_base64_ = false;
  VtkBlocks layout_;
  std::size_t budget_ = kMostBytes;
  VtkPolyData data_;
  bool has_radii_ = false;
};

}  // namespace

VtkPolyData readVtp(std::string_view bytes, const std::string& path)
{
  return VtpReader(bytes, path).read();
}

}  // namespace endovascular_sim::vessel
