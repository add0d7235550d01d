/**
 * @file
 * Reads the fields of a JSON body and remembers the first thing that is wrong.
 */
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "http/message.hpp"

namespace interlock::web {

/** After an error every read gives nothing, so that a caller reads all fields first and asks for the problem
 * then. */
class Fields {
 public:
  /** 422 INVALID when the body is no object or has a field that is not known. */
  Fields(const nlohmann::json& body, std::initializer_list<const char*> known);

  [[nodiscard]] bool has(const std::string& name) const;

  /** An integer from `lowest` to `highest`; nothing when the field is absent. */
  std::optional<std::int64_t> integer(const std::string& name, std::int64_t lowest, std::int64_t highest);

  /** A number; nothing when the field is absent. */
  std::optional<double> number(const std::string& name);

  /** Reports the first problem; 422 INVALID naming the field. */
  void reject(const std::string& name, const std::string& found, const std::string& expected);

  [[nodiscard]] const std::optional<Problem>& problem() const { return problem_; }

 private:
  const nlohmann::json& body_;
  std::optional<Problem> problem_;
};

}  // namespace interlock::web
