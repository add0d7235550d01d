#include "robot/robot_text.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "robot/table_reader.hpp"

namespace interlock {
namespace {

struct Edit {
  std::size_t begin;
  std::size_t end;
  std::string text;
};

/** Offset of a place that counts lines and characters from 1. */
std::size_t offset_of(std::string_view text, const toml::source_position& place) {
  std::size_t offset = 0;
  for (toml::source_index line = 1; line < place.line; ++line) {
    offset = text.find('\n', offset) + 1;
  }
  const auto begins_character = [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; };
  for (toml::source_index column = 1; column < place.column; ++column) {
    do {
      ++offset;
    } while (offset < text.size() && !begins_character(text[offset]));
  }
  return offset;
}

const toml::table* axis_table(const toml::table& robot, std::string_view name) {
  if (const toml::array* const axes = robot["axis"].as_array()) {
    for (const toml::node& axis : *axes) {
      const toml::table* const table = axis.as_table();
      if (table != nullptr && (*table)["name"].value<std::string_view>() == name) {
        return table;
      }
    }
  }
  return nullptr;
}

std::string written(double value, bool whole) {
  if (whole) {
    return std::to_string(std::llround(value));
  }
  const std::string text = text_of(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/** The key of `before` as its line has it may begin with those of its tables: "drive.max = 1". */
Edit behind(std::string_view text, const toml::node& before, const AxisNumber& number) {
  const std::size_t value = offset_of(text, before.source().begin);
  const std::size_t begin = text.find_last_of("{,\n", text.rfind('=', value)) + 1;
  const bool inside = begin > 0 && text[begin - 1] != '\n';
  const std::size_t end = offset_of(text, before.source().end);
  const std::size_t place = inside ? end : std::min(text.find('\n', end), text.size());
  std::string_view key = text.substr(begin, text.rfind('=', value) - begin);
  key.remove_prefix(inside ? std::min(key.find_first_not_of(" \t"), key.size()) : 0);
  const std::size_t last = key.find_last_of(". \t", key.find_last_not_of(" \t"));
  const std::size_t begins = last == std::string_view::npos ? 0 : last + 1;
  return {place, place,
          (inside ? ", " : "\n") + std::string(key.substr(0, begins)) +
              number.key.substr(number.key.rfind('.') + 1) + " = " + written(number.value, false)};
}

}  // namespace

tl::expected<std::string, RobotError> with_numbers(std::string_view text, std::string file,
                                                   std::string_view axis,
                                                   std::span<const AxisNumber> numbers) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    return tl::unexpected(RobotError{std::move(file), error.source().begin.line, "",
                                     std::string(error.description()), "a TOML file"});
  }
  const toml::table* const table = axis.empty() ? &root : axis_table(root, axis);
  if (table == nullptr) {
    return tl::unexpected(RobotError{std::move(file), 0, "axis",
                                     "no axis is called \"" + std::string(axis) + '"',
                                     "the name of an axis of this robot"});
  }
  std::vector<Edit> edits;
  for (const AxisNumber& number : numbers) {
    const toml::node* const node = table->at_path(number.key).node();
    const toml::node* const before = number.after.empty() ? nullptr : table->at_path(number.after).node();
    if (node == nullptr && before != nullptr) {
      edits.push_back(behind(text, *before, number));
      continue;
    }
    if (node == nullptr || !node->is_number()) {
      return tl::unexpected(
          RobotError{std::move(file), table->source().begin.line,
                     axis.empty() ? number.key : "axis." + std::string(axis) + '.' + number.key,
                     "no number stands there", "a number"});
    }
    edits.push_back({offset_of(text, node->source().begin), offset_of(text, node->source().end),
                     written(number.value, node->is_integer())});
  }
  std::ranges::sort(edits, std::greater{}, &Edit::begin);
  std::string edited(text);
  for (const Edit& edit : edits) {
    edited.replace(edit.begin, edit.end - edit.begin, edit.text);
  }
  return edited;
}

}  // namespace interlock
