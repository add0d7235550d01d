/**
 * @file
 * Reads the fields of a JSON object and remembers the first thing that is wrong.
 */
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "service/reply.hpp"

namespace interlock {

/** A number, or the one in a string that is spelt as JSON spells numbers; nothing for any other value. */
std::optional<double> number_of(const nlohmann::json& value);

/** A value as errors show it: as JSON, cut short. */
std::string quoted(const nlohmann::json& value);

/**
 * After an error every read gives nothing, so that a caller reads all fields first and asks for the problem
 * then. Numbers may be sent as strings that hold one, spelt as JSON spells numbers.
 */
class Fields {
 public:
  /**
   * 422 INVALID when the object is none or has a field that is not known.
   *
   * @param where place of the object in the body, as "file.axes[2]"; empty for the body itself
   */
  Fields(const nlohmann::json& object, std::initializer_list<const char*> known, std::string where = "");

  /** Of an object whose other fields somebody else reads: all are known. */
  static Fields some_of(const nlohmann::json& object);

  /** Whether the body has a field of that name. */
  [[nodiscard]] bool has(const std::string& name) const;

  /** An integer from `lowest` to `highest`; nothing when the field is absent. */
  std::optional<std::int64_t> integer(const std::string& name, std::int64_t lowest, std::int64_t highest);

  /** As `integer`, or nothing for null too. */
  std::optional<std::int64_t> integer_or_null(const std::string& name, std::int64_t lowest,
                                              std::int64_t highest);

  /** A number; nothing when the field is absent. */
  std::optional<double> number(const std::string& name);

  /** A number from `lowest` to `highest`; nothing when the field is absent. */
  std::optional<double> number(const std::string& name, double lowest, double highest);

  /** As many numbers as `count` says; nothing when the field is absent. A wrong element is named: "pose[3]".
   */
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t count);

  /** A field that is true or false; a problem is noted when it is not. */
  std::optional<bool> boolean(const std::string& name);

  /** A field that is a text; a problem is noted when it is not. */
  std::optional<std::string> text(const std::string& name);

  /** A text of one line of at most that many characters, some of which can be seen. */
  std::optional<std::string> line(const std::string& name, std::size_t longest);

  /** One of `choices`; nothing when the field is absent. */
  std::optional<std::string> choice(const std::string& name, std::span<const std::string_view> choices);

  /** `fewest` to `most` texts; nothing when the field is absent. */
  std::optional<std::vector<std::string>> texts(const std::string& name, std::size_t fewest,
                                                std::size_t most);

  /** The value as it came, to be read by `Fields` of its own; null when the field is absent. */
  [[nodiscard]] const nlohmann::json* value(const std::string& name) const;

  /** Each field must be there; the first that is not is reported with what belongs there. */
  void require(std::initializer_list<std::pair<const char*, const char*>> names_and_expected);

  /** Reports the first problem; 422 INVALID naming the field. */
  void reject(const std::string& name, const std::string& found, const std::string& expected);

  /** Takes over the first problem of what is part of the object. */
  void adopt(const Fields& part) { problem_ = problem_ ? problem_ : part.problem_; }

  /** `name` as a field of the whole body: "file.axes[2].axis". */
  [[nodiscard]] std::string place_of(const std::string& name) const;

  [[nodiscard]] const std::optional<Problem>& problem() const { return problem_; }

 private:
  explicit Fields(const nlohmann::json& object) : object_(object) {}

  const nlohmann::json& object_;
  std::string where_;
  std::optional<Problem> problem_;
};

/** "the body is wrong" in one place: 422 INVALID naming `field`. */
Problem invalid(const std::string& field, const std::string& detail, const std::string& expected);

}  // namespace interlock
