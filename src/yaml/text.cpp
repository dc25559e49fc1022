#include "yaml/text.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "common/error.h"

namespace endovascular_sim::yaml
{
namespace
{

constexpr int kMostDocuments = 100;  ///< of one text, all but one empty

/** Counts the values of a YAML text with its aliases expanded, without building them. */
class ValueCounter : public YAML::EventHandler
{
public:
  ValueCounter(const std::string& origin, const std::string& where) : origin_(origin), where_(where) {}

  void OnDocumentStart(const YAML::Mark& mark) override
  {
    is_second_ = documents_++ > 0;
    document_ = mark;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override
  {
    if (!open_.empty())  // otherwise an empty document
      addLeaf(mark, anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override
  {
    const bool is_key = isKey();
    if (is_key && value == "<<" && tag == "?")
      refuse(mark, "merge keys (<<) are not supported; write the keys out");
    if (is_key && open_.size() == 1)
      key_ = value;
    addLeaf(mark, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override
  {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end())
      refuse(mark, "an anchor must not contain itself");
    add(mark, found->second);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override
  {
    open(mark, anchor, false);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override
  {
    open(mark, anchor, true);
  }
  void OnMapEnd() override { close(); }

private:
  /** Number of values and levels of a value. */
  struct Extent
  {
    std::size_t values = 1;
    std::size_t depth = 0;
  };

  /** List or map that is being read. */
  struct Container
  {
    YAML::Mark mark;
    YAML::anchor_t anchor;
    bool is_map;
    Extent extent{1, 1};
    std::size_t children = 0;
  };

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& remedy) const
  {
    const std::string line = "line " + std::to_string(mark.line + 1);
    throw InputError(origin_, !where_.empty() ? where_ : key_.empty() ? line : key_ + " (" + line + ")", remedy);
  }

  bool isKey() const { return !open_.empty() && open_.back().is_map && open_.back().children % 2 == 0; }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, bool is_map)
  {
    requireOneDocument();
    if (open_.size() >= kMaxYamlDepth)
      refuse(mark, tooDeep());
    open_.push_back({mark, anchor, is_map});
  }

  void close()
  {
    const Container done = open_.back();
    open_.pop_back();
    if (done.anchor != 0)
      anchors_[done.anchor] = done.extent;
    add(done.mark, done.extent);
  }

  void addLeaf(const YAML::Mark& mark, YAML::anchor_t anchor)
  {
    requireOneDocument();
    if (anchor != 0)
      anchors_[anchor] = Extent();
    add(mark, Extent());
  }

  void add(const YAML::Mark& mark, const Extent& extent)
  {
    if (open_.empty())
      return;
    Container& parent = open_.back();
    ++parent.children;
    parent.extent.values += extent.values;
    parent.extent.depth = std::max(parent.extent.depth, extent.depth + 1);
    if (open_.size() + extent.depth > kMaxYamlDepth)
      refuse(mark, tooDeep());
    if (parent.extent.values > kMaxYamlValues)
      refuse(mark, "has more than " + std::to_string(kMaxYamlValues) +
                       " values, those of aliases (*name) counted at each use; give fewer");
  }

  static std::string tooDeep() { return "is nested deeper than " + std::to_string(kMaxYamlDepth) + " levels"; }

  /** Refuses a second document with content. */
  void requireOneDocument() const
  {
    if (is_second_)
      throw InputError(origin_, where_.empty() ? "line " + std::to_string(document_.line + 1) : where_,
                       "begins a second document (---), which would be ignored; keep one");
  }

  const std::string& origin_;
  const std::string& where_;
  std::string key_;  ///< present key of the root
  std::vector<Container> open_;
  std::map<YAML::anchor_t, Extent> anchors_;
  YAML::Mark document_;  ///< begin of the present document
  int documents_ = 0;
  bool is_second_ = false;
};

/** Number of the first line up to @p last whose indentation has a tab; 0: none. */
int lineWithTab(const std::string& text, int last)
{
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; number <= last && std::getline(stream, line); ++number)
    if (line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string::npos)
      return number;
  return 0;
}

[[noreturn]] void refuseSyntax(const YAML::Exception& error, const std::string& text, const std::string& origin,
                               const std::string& where)
{
  const int line = error.mark.line + 1;
  const int tab = lineWithTab(text, line);
  throw InputError(origin, where.empty() ? "line " + std::to_string(tab > 0 ? tab : line) : where,
                   tab > 0 ? "is indented by a tab, which YAML forbids; use blanks"
                           : "is not valid YAML: " + error.msg + "; check indentation, colons and brackets");
}

}  // namespace

YAML::Node parseYamlText(const std::string& text, const std::string& origin, const std::string& where)
{
  try
  {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    ValueCounter counter(origin, where);
    // The parser does not pass some misplaced signs, such as a comma at the beginning of a text: an empty document then
    // begins there again and again.
    for (int documents = 0; parser.HandleNextDocument(counter); ++documents)
      if (documents == kMostDocuments)
        throw InputError(origin, where,
                         "is not valid YAML: it begins " + std::to_string(documents) +
                             " empty documents; check the first sign of each line, which may be no comma");
    return YAML::Load(text);
  }
  catch (const YAML::Exception& error)
  {
    refuseSyntax(error, text, origin, where);
  }
}

}  // namespace endovascular_sim::yaml
