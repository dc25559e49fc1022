#include "vessel/io/obj_reader.h"

#include <set>
#include <vector>

#include "common/error.h"
#include "vessel/io/text_cursor.h"

namespace endovascular_sim::vessel
{
namespace
{

[[noreturn]] void refuse(const std::string& path, std::size_t line, const std::string& reason)
{
  throw InputError(path, "line " + std::to_string(line), reason);
}

/** Statements of an OBJ text; a backslash at the end of a line continues the statement. */
class ObjReader
{
public:
  ObjReader(std::string_view text, const std::string& path, MeshBuilder& mesh) : text_(text), path_(path), mesh_(mesh)
  {
  }

  void read()
  {
    while (text_.nextLine())
    {
      const std::string_view line = text_.restOfLine();
      const std::string_view keyword = text_.word();
      if (keyword == "v")
        readVertex();
      else if (keyword == "f")
        readFace();
      else if (!keyword.empty() && keyword.front() == '#')
        mesh_.readSpace(line);
      else
        skipStatement(keyword);
      mesh_.reportRest(text_.restOfText().size());
    }
  }

private:
  /** Next word of the statement, across continued lines; empty at its end or at a comment. */
  std::string_view word()
  {
    std::string_view word = text_.word();
    while (word == "\\" && text_.nextLine())
      word = text_.word();
    return !word.empty() && word.front() == '#' ? std::string_view() : word;
  }

  /** Skips a statement without vertices or faces. An unknown keyword is an error: in a damaged file it may have been a
   * vertex, whose loss would renumber all later ones. */
  void skipStatement(std::string_view keyword)
  {
    static const std::set<std::string_view> kKnown{
        "vt",     "vn",         "vp",        "p",     "l",        "curv",     "curv2", "surf",   "deg",    "bmat",
        "step",   "cstype",     "parm",      "trim",  "hole",     "scrv",     "sp",    "end",    "con",    "g",
        "s",      "mg",         "o",         "bevel", "c_interp", "d_interp", "lod",   "usemtl", "mtllib", "usemap",
        "maplib", "shadow_obj", "trace_obj", "ctech", "stech",    "call",     "csh"};
    if (!keyword.empty() && kKnown.count(keyword) == 0)
      refuse(path_, text_.lineNumber(),
             "'" + std::string(keyword.substr(0, 20)) + "' is no statement of an OBJ file; the file is damaged");
    if (keyword.empty())
      return;
    while (!word().empty())  // to the end of continued lines
      continue;
  }

  void readVertex()
  {
    const std::size_t line = text_.lineNumber();
    Eigen::Vector3d position;
    for (int k = 0; k < 3; ++k)
      if (!parseNumber(word(), position[k]))
        refuse(path_, line, "a vertex needs three numbers");
    // A weight, or a colour with or without it, may follow.
    std::size_t others = 0;
    for (std::string_view other = word(); !other.empty(); other = word(), ++others)
      if (double value = 0.0; others == 4 || !parseNumber(other, value))
        refuse(path_, line, "a vertex has three numbers, and at most four more for weight and colour");
    mesh_.addVertex(position, line);
  }

  void readFace()
  {
    const std::size_t line = text_.lineNumber();
    corners_.clear();
    for (std::string_view corner = word(); !corner.empty(); corner = word())
    {
      long long number = 0;
      if (!parseNumber(corner.substr(0, corner.find('/')), number) || number == 0 ||
          corner.find_first_not_of("+-/0123456789") != std::string_view::npos)
        refuse(path_, line, "a face needs vertex numbers from 1, or negative ones relative to the last vertex");
      corners_.push_back(number > 0 ? number - 1 : static_cast<long long>(mesh_.vertices()) + number);
    }
    mesh_.addFace(corners_, line);
  }

  TextCursor text_;
  const std::string& path_;
  MeshBuilder& mesh_;
  std::vector<long long> corners_;
};

}  // namespace

void readObj(std::string_view text, const std::string& path, MeshBuilder& mesh)
{
  ObjReader(withoutByteOrderMark(text), path, mesh).read();
}

}  // namespace endovascular_sim::vessel
