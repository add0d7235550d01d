/**
 * @file
 * Reads one TOML table key by key and remembers the first thing that is wrong. Private to this folder and
 * to the families of kinematics.
 *
 * After an error every read answers with a harmless value, so that a caller reads a whole table as plain
 * assignments and asks once, at the end, whether it was sound.
 */
#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "robot/robot_error.hpp"
#include "robot/unit.hpp"

namespace interlock {

/** Up to six digits of a number, for people. */
std::string text_of(double number);

/** What reading has found so far, over all tables of a file. */
struct ReadLog {
  Origin origin;
  std::optional<RobotError> first_error;

  /** Keeps the error unless there is an earlier one. */
  void refuse(std::uint32_t line, std::string key, std::string problem, std::string expected);
};

/** Reads the keys of one table and notes what is wrong with them. */
class TableReader {
 public:
  /** @param path dotted path of the table, empty for the whole file. The table and the log must outlive this.
   */
  TableReader(ReadLog& log, const toml::table& table, std::string path);

  /** Whether the key is there; an optional key is asked for before it is read. */
  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }

  /** Text that is not empty. */
  std::string text(std::string_view key);

  /** Text that can stand in paths and programs: a lower-case letter, then lower-case letters, digits and `_`.
   */
  std::string identifier(std::string_view key);

  /** The value of a key that is true or false. */
  bool boolean(std::string_view key);

  /** A finite number; an integer will do. */
  double number(std::string_view key);

  /** A number from `lowest` to `highest`. */
  double number_between(std::string_view key, double lowest, double highest);

  /** A length in mm, greater than 0. */
  double length_mm(std::string_view key);

  /** A length in mm that may be 0, or lie on the other side. */
  double offset_mm(std::string_view key);

  /** An array of x, y and z in mm. */
  PointMm point_mm(std::string_view key);

  /** An array of exactly `count` finite numbers; zeros when it is none. */
  std::vector<double> numbers(std::string_view key, std::size_t count);

  /** An array of finite numbers; `expected` says for what. */
  std::vector<double> numbers(std::string_view key, const std::string& expected);

  /** A whole number that the type can hold. */
  template <typename Integer>
  Integer integer(std::string_view key) {
    using Limits = std::numeric_limits<Integer>;
    return static_cast<Integer>(integer_between(key, Limits::min(), Limits::max()));
  }

  /** A whole number from `lowest` to `highest`. */
  std::int64_t integer_between(std::string_view key, std::int64_t lowest, std::int64_t highest);

  /** Milliseconds that are a whole number of control periods, as periods. */
  std::uint32_t ticks(std::string_view key, std::uint32_t period_us);

  /** One of the words; `words` lists them with their values. */
  template <typename Words>
  auto choice(std::string_view key, const Words& words) {
    std::string expected = "one of";
    for (const auto& [word, value] : words) {
      expected += (word == words.front().first ? " \"" : ", \"") + std::string(word) + '"';
    }
    const toml::node* const node = take(key, expected);
    const std::optional<std::string> given = node ? node->value_exact<std::string>() : std::nullopt;
    for (const auto& [word, value] : words) {
      if (given == word) {
        return value;
      }
    }
    if (node) {
      refuse_value(key, *node, expected);
    }
    return words.front().second;
  }

  /** A table inside this one. When it is missing, the answer is an empty table that refuses nothing further.
   */
  TableReader table(std::string_view key);

  /** Every table of an array of tables, named "KEY[0]", "KEY[1]" and so on. */
  std::vector<TableReader> tables(std::string_view key, const std::string& expected);

  /** Every text of an array of texts, none of them empty. */
  std::vector<std::string> texts(std::string_view key, const std::string& expected);

  /** The keys that are there, by their names. */
  [[nodiscard]] std::vector<std::string> keys() const;

  /** Refuses what is there but was not asked for. */
  void refuse_unknown_keys();

  /** Refuses the value of a key for a reason that only the caller knows. */
  void refuse(std::string_view key, std::string problem, std::string expected);

  /** Likewise, and says what is given. */
  void refuse_given(std::string_view key, const std::string& problem, std::string expected);

  /** Refuses the table as a whole. */
  void refuse_table(std::string problem, std::string expected);

  /** Names the table from here on. */
  void rename(std::string path) { path_ = std::move(path); }

  /** Dotted path of a key of this table. */
  [[nodiscard]] std::string path_of(std::string_view key) const;

 private:
  const toml::node* take(std::string_view key, const std::string& expected);
  const toml::array& array(std::string_view key, const std::string& expected);
  void refuse_value(std::string_view key, const toml::node& node, const std::string& expected);

  ReadLog& log_;
  const toml::table& table_;
  std::string path_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace interlock
