/**
 * @file
 * Why the store did not do what was asked.
 */
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace interlock {

/** A refusal by a rule, or a failure of the file. Whoever gets one knows that nothing was changed. */
struct StoreError {
  /** What went wrong. */
  enum class Kind {
    invalid,      /**< a value breaks a rule: `field` and `expected` say which */
    exists,       /**< the name is taken */
    not_found,    /**< there is nothing of that name */
    last_admin,   /**< somebody who may administer must be left */
    session_over, /**< whoever asked is not logged in any more */
    role,         /**< the user who asked may not, or not any more */
    outdated,     /**< what was decided upon has changed meanwhile: begin anew */
    no_memory,    /**< a password cannot be hashed now */
    unavailable,  /**< the file cannot be read or written now: disk full, no permission, busy */
    newer,        /**< the file was written by a newer release */
    damaged       /**< the file is not a sound store of Interlock */
  };

  Kind kind = Kind::unavailable;
  std::string problem;   /**< what was found, and where */
  std::string field;     /**< name of the value that is wrong; empty where it is none */
  std::string expected;  /**< what belongs there instead; may be empty */
  std::string next_step; /**< what to do about it; may be empty */

  /** One line for people: problem, what was expected, what to do. */
  [[nodiscard]] std::string message() const;

  bool operator==(const StoreError&) const = default;
};

/** A value, or why the store has none. */
template <typename Value>
using Stored = tl::expected<Value, StoreError>;

}  // namespace interlock
