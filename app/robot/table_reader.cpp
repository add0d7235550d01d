#include "robot/table_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>
#include <sstream>

namespace interlock {
namespace {

const toml::table empty_table;

/** No length of a robot is more. */
constexpr double farthest_mm = 1000.0;

std::uint32_t line_of(const toml::node& node) { return node.source().begin.line; }

/** The shortest digits that read back as this number. */
std::string shortest(double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  return {digits.data(), end};
}

std::string described(const toml::node& node) {
  if (node.is_table() && !node.as_table()->is_inline()) {
    return "a table is given";
  }
  if (node.is_array()) {
    return "an array is given";
  }
  if (const std::optional<double> number = node.value_exact<double>()) {
    return shortest(*number) + " is given";
  }
  std::ostringstream text;
  text << toml::node_view<const toml::node>(node) << " is given";
  return text.str();
}

/** Not a number when it is none, or a whole number with more digits than a double holds. */
double number_of(const toml::node& node) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return node.is_number() ? node.value<double>().value_or(none) : none;
}

std::string range_text(std::int64_t lowest, std::int64_t highest) {
  return "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
}

}  // namespace

std::string text_of(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

void ReadLog::refuse(std::uint32_t line, std::string key, std::string problem, std::string expected) {
  if (!first_error) {
    first_error = RobotError{origin.file, line, std::move(key), std::move(problem), std::move(expected)};
  }
}

TableReader::TableReader(ReadLog& log, const toml::table& table, std::string path)
    : log_(log), table_(table), path_(std::move(path)) {}

std::string TableReader::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + '.' + std::string(key);
}

const toml::node* TableReader::take(std::string_view key, const std::string& expected) {
  known_.emplace(key);
  const toml::node* const node = table_.get(key);
  if (!node) {
    log_.refuse(line_of(table_), path_of(key), "the key is missing", expected);
    return nullptr;
  }
  log_.origin.keys[path_of(key)] = {line_of(*node), described(*node)};
  return node;
}

void TableReader::refuse_value(std::string_view key, const toml::node& node, const std::string& expected) {
  log_.refuse(line_of(node), path_of(key), described(node), expected);
}

void TableReader::refuse(std::string_view key, std::string problem, std::string expected) {
  const toml::node* const node = table_.get(key);
  log_.refuse(line_of(node ? *node : table_), path_of(key), std::move(problem), std::move(expected));
}

void TableReader::refuse_given(std::string_view key, const std::string& problem, std::string expected) {
  const toml::node* const node = table_.get(key);
  refuse(key, node ? described(*node) + ": " + problem : problem, std::move(expected));
}

std::string TableReader::text(std::string_view key) {
  const std::string expected = "text that is not empty";
  const toml::node* const node = take(key, expected);
  if (!node) {
    return {};
  }
  std::string given = node->value_exact<std::string>().value_or("");
  if (given.empty()) {
    refuse_value(key, *node, expected);
  }
  return given;
}

std::string TableReader::identifier(std::string_view key) {
  static const std::regex pattern("[a-z][a-z0-9_]*");
  const std::string expected = "a name of lower-case letters, digits and _, a letter first";
  const toml::node* const node = take(key, expected);
  if (!node) {
    return {};
  }
  std::string given = node->value_exact<std::string>().value_or("");
  if (!std::regex_match(given, pattern)) {
    refuse_value(key, *node, expected);
  }
  return given;
}

bool TableReader::boolean(std::string_view key) {
  const std::string expected = "true or false";
  const toml::node* const node = take(key, expected);
  if (node && !node->is_boolean()) {
    refuse_value(key, *node, expected);
  }
  return node && node->value_exact<bool>().value_or(false);
}

double TableReader::number(std::string_view key) {
  const std::string expected = "a finite number";
  const toml::node* const node = take(key, expected);
  if (!node) {
    return 0.0;
  }
  const double given = number_of(*node);
  if (!std::isfinite(given)) {
    refuse_value(key, *node, expected);
  }
  return given;
}

double TableReader::number_between(std::string_view key, double lowest, double highest) {
  const double given = number(key);
  if (given < lowest || given > highest) {
    if (const toml::node* const node = table_.get(key)) {
      refuse_value(key, *node, "a number from " + shortest(lowest) + " to " + shortest(highest));
    }
    return lowest;
  }
  return given;
}

double TableReader::length_mm(std::string_view key) { return number_between(key, 0.001, farthest_mm); }

double TableReader::offset_mm(std::string_view key) { return number_between(key, -farthest_mm, farthest_mm); }

PointMm TableReader::point_mm(std::string_view key) {
  const std::vector<double> point = numbers(key, 3);
  if (std::ranges::any_of(point, [](double mm) { return std::abs(mm) > farthest_mm; })) {
    refuse_given(key, "a coordinate is out of range",
                 "coordinates from " + shortest(-farthest_mm) + " to " + shortest(farthest_mm));
  }
  return {point[0], point[1], point[2]};
}

std::vector<double> TableReader::numbers(std::string_view key, std::size_t count) {
  const std::string expected = "an array of " + std::to_string(count) + " finite numbers";
  std::vector<double> found = numbers(key, expected);
  if (found.size() != count) {
    refuse(key, std::to_string(found.size()) + " entries are given", expected);
    found.assign(count, 0.0);
  }
  return found;
}

std::vector<double> TableReader::numbers(std::string_view key, const std::string& expected) {
  std::vector<double> found;
  for (const toml::node& entry : array(key, expected)) {
    found.push_back(number_of(entry));
    if (!std::isfinite(found.back())) {
      refuse_value(key, entry, expected);
    }
  }
  return found;
}

std::int64_t TableReader::integer_between(std::string_view key, std::int64_t lowest, std::int64_t highest) {
  const toml::node* const node = take(key, range_text(lowest, highest));
  if (!node) {
    return lowest;
  }
  const std::optional<std::int64_t> given = node->value_exact<std::int64_t>();
  if (const auto broken = node->value_exact<double>(); broken && *broken == std::floor(*broken)) {
    log_.refuse(line_of(*node), path_of(key), shortest(*broken) + " is given with a decimal point",
                range_text(lowest, highest) + " without one");
    return lowest;
  }
  if (!given || *given < lowest || *given > highest) {
    refuse_value(key, *node, range_text(lowest, highest));
    return lowest;
  }
  return *given;
}

std::uint32_t TableReader::ticks(std::string_view key, std::uint32_t period_us) {
  constexpr std::int64_t longest_ms = std::numeric_limits<std::uint32_t>::max() / 1000;
  const std::int64_t given_us = 1000 * integer_between(key, 0, longest_ms);
  if (period_us == 0) {
    return 0;
  }
  if (given_us % period_us != 0) {
    refuse(key, std::to_string(given_us / 1000) + " ms is not a whole number of control periods",
           "a multiple of period_us = " + std::to_string(period_us));
  }
  return static_cast<std::uint32_t>(given_us / period_us);
}

TableReader TableReader::table(std::string_view key) {
  const std::string expected = "a table";
  const toml::node* const node = take(key, expected);
  if (node && !node->is_table()) {
    refuse_value(key, *node, expected);
  }
  const toml::table* const found = node ? node->as_table() : nullptr;
  return TableReader(log_, found ? *found : empty_table, path_of(key));
}

const toml::array& TableReader::array(std::string_view key, const std::string& expected) {
  static const toml::array empty_array;
  const toml::node* const node = take(key, expected);
  if (node && !node->is_array()) {
    refuse_value(key, *node, expected);
  }
  return node && node->is_array() ? *node->as_array() : empty_array;
}

std::vector<TableReader> TableReader::tables(std::string_view key, const std::string& expected) {
  std::vector<TableReader> found;
  for (const toml::node& entry : array(key, expected)) {
    std::string path = path_of(key) + '[' + std::to_string(found.size()) + ']';
    if (!entry.is_table()) {
      log_.refuse(line_of(entry), std::move(path), described(entry), expected);
      break;
    }
    found.emplace_back(log_, *entry.as_table(), std::move(path));
  }
  return found;
}

std::vector<std::string> TableReader::texts(std::string_view key, const std::string& expected) {
  std::vector<std::string> found;
  for (const toml::node& entry : array(key, expected)) {
    found.push_back(entry.value_exact<std::string>().value_or(""));
    if (found.back().empty()) {
      refuse_value(key, entry, expected);
      break;
    }
  }
  return found;
}

std::vector<std::string> TableReader::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, node] : table_) {
    names.emplace_back(key.str());
  }
  return names;
}

void TableReader::refuse_table(std::string problem, std::string expected) {
  log_.refuse(line_of(table_), path_, std::move(problem), std::move(expected));
}

void TableReader::refuse_unknown_keys() {
  for (const auto& [key, node] : table_) {
    if (!known_.contains(key.str())) {
      std::string expected = "one of";
      for (const std::string& known : known_) {
        expected += (known == *known_.begin() ? " " : ", ") + known;
      }
      log_.refuse(key.source().begin.line, path_of(key.str()), "the key is unknown", std::move(expected));
    }
  }
}

}  // namespace interlock
