/**
 * @file
 * Why the app could not attach to a kernel.
 */
#pragma once

#include <string>

namespace interlock {

/** One failed attempt to attach. */
struct LinkError {
  /** Why there is no link. */
  enum class Kind {
    unreachable,  /**< nobody listens at the socket; trying again later may help */
    silent,       /**< connected, but no hello came in time */
    incompatible, /**< another build of the kernel: the same release must be installed on both sides */
    broken        /**< the hello or its memory is not what interlock/link.h promises */
  };

  Kind kind = Kind::unreachable;
  std::string detail; /**< what was found and what was expected */

  /** One line for people, with the next step. */
  [[nodiscard]] std::string message() const;

  bool operator==(const LinkError&) const = default;
};

}  // namespace interlock
