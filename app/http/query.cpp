#include "http/message.hpp"

namespace interlock::web {

using nlohmann::json;

tl::expected<json, Problem> known_query(const Request& request, std::initializer_list<const char*> known) {
  return parse_query(request).map([&](const json& query) {
    json found = json::object();
    for (const char* name : known) {
      if (query.contains(name)) {
        found[name] = query[name];
      }
    }
    return found;
  });
}

}  // namespace interlock::web
