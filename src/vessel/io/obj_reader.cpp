#include "vessel/io/obj_reader.h"

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
      const std::string_view keyword = text_.word();
      if (keyword == "v")
        readVertex();
      else if (keyword == "f")
        readFace();
      else if (!keyword.empty() && keyword.back() == '\\' && keyword.size() > 1)
        refuse(path_, text_.lineNumber(), "a keyword continues on the next line; the file is damaged");
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

  void readVertex()
  {
    const std::size_t line = text_.lineNumber();
    Eigen::Vector3d position;
    for (int k = 0; k < 3; ++k)
      if (!parseNumber(word(), position[k]))
        refuse(path_, line, "a vertex needs three numbers");
    mesh_.addVertex(position, line);
  }

  void readFace()
  {
    const std::size_t line = text_.lineNumber();
    corners_.clear();
    for (std::string_view corner = word(); !corner.empty(); corner = word())
    {
      long long number = 0;
      if (!parseNumber(corner.substr(0, corner.find('/')), number) || number == 0)
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
  ObjReader(text, path, mesh).read();
}

}  // namespace endovascular_sim::vessel
