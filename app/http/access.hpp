/**
 * @file
 * Who calls, and who may: the right that each route asks for.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "store/users.hpp"

namespace interlock::web {

/** Who sent a request. */
struct Caller {
  std::uint32_t session = 0; /**< 0: nobody is logged in */
  std::string user;
  std::optional<Role> role;
  std::string peer; /**< address and port that the request came from */
  /** When it asked, no later than that. */
  std::chrono::steady_clock::time_point asked = std::chrono::steady_clock::now();
};

/** `x-role` and `x-authority` of spec/openapi.yaml. */
struct Access {
  std::optional<Role> role; /**< the least that suffices; empty: anybody, even without login */
  bool authority = false;   /**< only the session that holds the motion authority */
};

constexpr Access anybody{};
constexpr Access viewers{Role::viewer};
constexpr Access engineers{Role::engineer};
constexpr Access admins{Role::admin};
constexpr Access holder{Role::engineer, true};

}  // namespace interlock::web
