#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/output_file.h"
#include "common/quantity.h"
#include "common/version.h"

namespace endovascular_sim::tools
{

/** Layout of `--help`: descriptions wrapped at 120 columns, each option followed by the name of its value. */
class HelpFormatter : public CLI::Formatter
{
public:
  HelpFormatter() { column_width(28); }

  /** Text wrapped at a width; line breaks of the text stay. */
  static std::string wrapped(const std::string& text, std::size_t width)
  {
    std::string result;
    std::size_t column = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
      result += result.empty() ? "" : "\n";
      column = 0;
      std::istringstream words(line);
      for (std::string word; words >> word;)
      {
        const bool fits = column == 0 || column + 1 + word.size() <= width;
        result += column == 0 ? "" : fits ? " " : "\n";
        column = (fits ? column + (column > 0 ? 1 : 0) : 0) + word.size();
        result += word;
      }
    }
    return result;
  }

  std::string make_option_opts(const CLI::Option* option) const override
  {
    if (option->get_type_size() == 0)
      return "";
    const bool repeated = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    const std::string value = option->get_type_name();
    const std::string name = value.substr(0, value.find(':'));  // without the names of the checks
    return (option->nonpositional() ? " " + name : "") + (repeated ? " ..." : "");
  }

  std::string make_option_desc(const CLI::Option* option) const override
  {
    return wrapped(option->get_description(), kWidth - get_column_width());
  }

  std::string make_description(const CLI::App* app) const override
  {
    return wrapped(app->get_description(), kWidth) + "\n\n";
  }

  std::string make_footer(const CLI::App* app) const override { return wrapped(app->get_footer(), kWidth) + "\n"; }

private:
  static constexpr std::size_t kWidth = 120;
};

/** Command line of a tool: `--help`, `--version`, and one style of messages and exit codes.
 *
 *  Exit codes: 1 for an exception of the tool, 2 for wrong arguments, else that of the tool. */
class CommandLine
{
public:
  /** @param footer last lines of `--help`, e.g. the exit codes */
  CommandLine(const std::string& name, const std::string& description, const std::string& footer)
    : name_(name), app_(description, name)
  {
    app_.formatter(std::make_shared<HelpFormatter>());
    app_.get_formatter()->label("Positionals", "Arguments");
    app_.footer(footer);
    app_.set_help_flag("-h,--help", "prints this text");
    app_.set_version_flag("--version", versionText(name), "prints version, commit and number of the physics");
  }

  /** Line that `--version` prints. */
  static std::string versionText(const std::string& name)
  {
    return name + " " + version() + ", commit " + commit() + ", physics " + std::to_string(kPhysicsNumber);
  }

  CLI::Option* flag(const std::string& name, bool& value, const std::string& description)
  {
    return app_.add_flag(name, value, description);
  }

  /** @param value default, replaced by the argument
   *  @param value_name name of the value in `--help` */
  template <typename Value>
  CLI::Option* option(const std::string& name, Value& value, const std::string& value_name,
                      const std::string& description)
  {
    return app_.add_option(name, value, description)->type_name(value_name);
  }

  /** Option with a physical quantity. An unusual value causes a warning, an impossible one is wrong.
   *  @param value default, replaced by the argument */
  CLI::Option* quantity(const std::string& name, double& value, const std::string& value_name, const Quantity& quantity,
                        const std::string& description)
  {
    const auto check = [this, name, quantity](const std::string& text) -> std::string
    {
      char* end = nullptr;
      const double number = std::strtod(text.c_str(), &end);
      if (text.empty() || *end != '\0' || plausibility(quantity, number) == Plausibility::kUsual)
        return "";
      std::string message = plausibilityMessage(quantity, number);
      if (plausibility(quantity, number) == Plausibility::kImpossible)
        return message;
      std::cerr << name_ << ": warning: " << name << ": " << message << "\n";
      return "";
    };
    return option(name, value, value_name, description)->check(CLI::Validator(check, ""));
  }

  /** Option that may be repeated, with one value each time. */
  CLI::Option* repeated(const std::string& name, std::vector<std::string>& values, const std::string& value_name,
                        const std::string& description)
  {
    return app_.add_option(name, values, description + "; may be repeated")
        ->type_name(value_name)
        ->allow_extra_args(false);
  }

  /** Option `--set`, which replaces values of a scene or an instrument. */
  CLI::Option* overrides(std::vector<std::string>& values, const std::string& description)
  {
    return repeated("--set", values, "key.path=value", description);
  }

  /** Required argument without a name of an option. */
  template <typename Value>
  CLI::Option* argument(const std::string& name, Value& value, const std::string& description)
  {
    return app_.add_option(name, value, description)->required();
  }

  /** Adds a condition over several arguments.
   *  @param condition returns the message for wrong arguments, or an empty text */
  void require(std::function<std::string()> condition) { conditions_.push_back(std::move(condition)); }

  /** Parses the arguments and runs the tool.
   *  @param tool returns the exit code
   *  @return exit code of the program */
  int run(int argc, const char* const* argv, const std::function<int()>& tool)
  {
    try
    {
      app_.parse(argc, argv);
      for (const std::function<std::string()>& condition : conditions_)
        if (const std::string message = condition(); !message.empty())
          return wrongArguments(message);
    }
    catch (const CLI::Success& request)  // --help, --version
    {
      return app_.exit(request);
    }
    catch (const CLI::RequiredError& error)
    {
      // A misspelt option also leaves the right one missing.
      const std::vector<std::string> unknown = app_.remaining();
      return wrongArguments(unknown.empty() ? error.what() : "unknown argument '" + unknown.front() + "'");
    }
    catch (const CLI::ExtrasError&)
    {
      return wrongArguments("unknown argument '" + app_.remaining().front() + "'");
    }
    catch (const CLI::ParseError& error)
    {
      return wrongArguments(error.what());
    }
    try
    {
      const int code = tool();
      if (!std::cout.flush() || std::fflush(stdout) != 0)
        throw writeError("standard output");
      return code;
    }
    catch (const std::bad_alloc&)
    {
      std::cerr << name_ << ": the memory does not suffice; use a smaller mesh or scene, or free some memory\n";
      return 1;
    }
    catch (const std::exception& error)
    {
      std::cerr << name_ << ": " << error.what() << "\n";
      return 1;
    }
  }

private:
  int wrongArguments(const std::string& message) const
  {
    std::cerr << name_ << ": " << message << "\n'" << name_ << " --help' lists the arguments.\n";
    return 2;
  }

  std::string name_;
  CLI::App app_;
  std::vector<std::function<std::string()>> conditions_;
};

/** Checks that a value is a number that meets a condition, which the message names, e.g. "above zero". */
inline CLI::Validator numberWith(const std::function<bool(double)>& condition, const std::string& words)
{
  return {[condition, words](std::string& text) -> std::string
          {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            const bool good = !text.empty() && *end == '\0' && condition(value);
            return good ? "" : "requires a number " + words + ", not '" + text + "'";
          },
          ""};
}

/** Checks that a value is a finite number above zero. */
inline CLI::Validator positiveNumber()
{
  return numberWith([](double value) { return std::isfinite(value) && value > 0.0; }, "above zero");
}

/** Checks that a value is a number that is not negative; infinity is allowed. */
inline CLI::Validator nonNegativeNumber()
{
  return numberWith([](double value) { return value >= 0.0; }, "that is not negative");
}

}  // namespace endovascular_sim::tools
