/**
 * @file
 * Reads the keys of a plant file and keeps the first fault, with its place.
 */
#ifndef INTERLOCK_PLANT_TOML_READER_HPP
#define INTERLOCK_PLANT_TOML_READER_HPP

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "plant/parameters.hpp"

namespace interlock::plant {

/** Reads the keys of one document and keeps the first fault. */
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  void fail(const toml::node& where, std::string_view key, const std::string& expected) {
    if (fault_.empty()) {
      fault_ =
          file_ + ":" + std::to_string(where.source().begin.line) + ": " + std::string(key) + ": " + expected;
    }
  }

  const std::string& fault() const { return fault_; }

  /** Overwrites `value` when the key is there. */
  bool number(const toml::table& table, std::string_view key, Range range, double& value) {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      return false;
    }
    const std::optional<double> found = node->value<double>();
    if (!node->is_number() || !found || !std::isfinite(*found) || *found < range.least ||
        *found > range.most) {
      std::ostringstream expected;
      expected << "expected a number from " << range.least << " to " << range.most;
      fail(*node, key, expected.str());
      return false;
    }
    value = *found;
    return true;
  }

  bool integer(const toml::table& table, std::string_view key, Range range, std::uint32_t& value) {
    double found = value;
    if (!number(table, key, range, found)) {
      return false;
    }
    if (!table.get(key)->is_integer()) {
      fail(*table.get(key), key, "expected a whole number");
      return false;
    }
    value = static_cast<std::uint32_t>(found);
    return true;
  }

  void milliseconds(const toml::table& table, std::string_view key, Range range, Microseconds& value) {
    double found = 0;
    if (number(table, key, range, found)) {
      value = Microseconds(static_cast<std::uint64_t>(std::llround(found * 1000)));
    }
  }

  /** The table of that key; an empty one when there is none. */
  const toml::table& section(const toml::table& table, std::string_view key) {
    static const toml::table empty;
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      return empty;
    }
    if (!node->is_table()) {
      fail(*node, key, "expected a table");
      return empty;
    }
    return *node->as_table();
  }

  /** The tables of that array; none when there is no array. */
  std::vector<const toml::table*> tables(const toml::table& table, std::string_view key) {
    std::vector<const toml::table*> found;
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      return found;
    }
    if (!node->is_array_of_tables()) {
      fail(*node, key, "expected tables, each after a line with [[" + std::string(key) + "]]");
      return found;
    }
    for (const toml::node& entry : *node->as_array()) {
      found.push_back(entry.as_table());
    }
    return found;
  }

  /** Fails on the first key that is in neither list. */
  void only(const toml::table& table, std::vector<std::string_view> known,
            std::span<const std::string_view> more = {}) {
    known.insert(known.end(), more.begin(), more.end());
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
        std::string keys;
        for (const std::string_view name : known) {
          keys += (keys.empty() ? "" : ", ") + std::string(name);
        }
        fail(node, key.str(), "unknown key; expected one of " + keys);
      }
    }
  }

 private:
  std::string file_;
  std::string fault_;
};

}  // namespace interlock::plant

#endif
