#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "http/message.hpp"

namespace interlock::web {
namespace {

using nlohmann::json;

/** Walks through a text without keeping it, and stops at the first flaw. */
class Shape {
 public:
  [[nodiscard]] const std::optional<std::string>& flaw() const { return flaw_; }

  bool null() { return true; }
  bool boolean(bool) { return true; }
  bool number_integer(json::number_integer_t) { return true; }
  bool number_unsigned(json::number_unsigned_t) { return true; }
  bool number_float(json::number_float_t, const json::string_t&) { return true; }
  bool string(json::string_t&) { return true; }
  bool binary(json::binary_t&) { return true; }
  bool start_object(std::size_t) { return enter(); }
  bool end_object() { return leave(); }
  bool start_array(std::size_t) { return enter(); }
  bool end_array() { return leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) { return false; }

  bool key(json::string_t& name) {
    if (!keys_.back().insert(name).second) {
      flaw_ = "has the key \"" + name + "\" twice in one object";
    }
    return !flaw_;
  }

 private:
  bool enter() {
    if (keys_.size() == deepest_json) {
      flaw_ = "is nested deeper than " + std::to_string(deepest_json);
    }
    keys_.emplace_back();
    return !flaw_;
  }

  bool leave() {
    keys_.pop_back();
    return true;
  }

  std::vector<std::set<std::string>> keys_; /**< of each object that is open; none of an array */
  std::optional<std::string> flaw_;
};

}  // namespace

std::optional<std::string> flaw_of_json(std::string_view text) {
  Shape shape;
  json::sax_parse(text.begin(), text.end(), &shape);
  return shape.flaw();
}

}  // namespace interlock::web
