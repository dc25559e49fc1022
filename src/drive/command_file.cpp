#include "drive/command_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "common/error.h"
#include "common/input_file.h"
#include "drive/joint_command.h"

namespace endovascular_sim::drive
{
namespace
{

constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

/** Fields of a row, without blanks at their ends and without the quotation marks around them that spreadsheets write.
 */
std::vector<std::string> fieldsOf(const std::string& line)
{
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');)
  {
    const auto begin = field.find_first_not_of(" \t\r");
    const auto end = field.find_last_not_of(" \t\r");
    fields.push_back(begin == std::string::npos ? "" : field.substr(begin, end - begin + 1));
    std::string& text = fields.back();
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
      text = text.substr(1, text.size() - 2);
  }
  return fields;
}

bool isEmpty(const std::vector<std::string>& fields)
{
  return std::all_of(fields.begin(), fields.end(), [](const std::string& field) { return field.empty(); });
}

/** Row of a file, for errors. */
struct Row
{
  std::string file;
  int line = 0;

  [[noreturn]] void reject(const std::string& remedy) const
  {
    throw InputError(file, "line " + std::to_string(line), remedy);
  }

  double number(const std::string& text) const
  {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (text.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
      reject("'" + text + "' is not a finite number");
    return value;
  }
};

TimedCommand commandOf(const Row& row, const std::vector<std::string>& fields)
{
  if (fields.size() < 3)
    row.reject("expected time, instrument, command and values, separated by commas");
  TimedCommand command{row.number(fields[0]), fields[1], fields[2], {}, row.line};
  for (std::size_t i = 3; i < fields.size(); ++i)
    command.values.push_back(row.number(fields[i]));
  const bool is_state = isStateCommand(command.word);
  if (is_state ? !command.values.empty() : command.values.empty() || command.values.size() > 3)
    row.reject(is_state ? "'" + command.word + "' has no values"
                        : "expected one to three values: insertion, rotation, pressure");
  if (!is_state && !commandKind(command.word))
    row.reject("unknown command '" + command.word +
               "'; known are servo_jp, servo_jr, servo_jv, servo_jf, move_jp, move_jr, enable, disable, pause, resume, "
               "home, unhome, hold and free");
  return command;
}

}  // namespace

std::vector<TimedCommand> readCommandFile(const std::string& path)
{
  std::ifstream stream = openInputFile(path, "give a file with rows of time,instrument,command,values");
  std::vector<TimedCommand> commands;
  Row row{path, 0};
  for (std::string line; std::getline(stream, line);)
  {
    if (++row.line == 1 && line.rfind(kByteOrderMark, 0) == 0)
      line.erase(0, 3);
    const std::vector<std::string> fields = fieldsOf(line);
    const bool is_heading = commands.empty() && !fields.empty() && fields[0] == "time";
    if (isEmpty(fields) || line.front() == '#' || is_heading)
      continue;
    commands.push_back(commandOf(row, fields));
    if (commands.size() > 1 && commands.back().time < commands[commands.size() - 2].time)
      row.reject("lies before the row above; sort the rows by time");
  }
  return commands;
}

}  // namespace endovascular_sim::drive
