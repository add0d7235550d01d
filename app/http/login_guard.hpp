/**
 * @file
 * Slows down whoever guesses passwords: after three wrong ones for a name, each further attempt has to wait.
 */
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

#include "http/clocks.hpp"

namespace interlock::web {

class LoginGuard {
 public:
  /** Names that are remembered; beyond them the one whose last attempt is oldest is forgotten. */
  static constexpr std::size_t capacity = 4096;

  /** How long an attempt for that name has to wait; zero: it may be judged now. */
  [[nodiscard]] std::chrono::seconds wait(const std::string& name, SteadyTime now) const;

  /** An attempt is about to be judged. It counts as wrong until it turns out right, so that many at the same
   * time gain nothing. */
  void begin(const std::string& name, SteadyTime now);

  /** The attempt was judged. */
  void end(const std::string& name, bool right);

  /** The attempt could not be judged. */
  void end_unjudged(const std::string& name);

 private:
  struct Attempts {
    unsigned wrong = 0; /**< in a row */
    SteadyTime last;
  };

  std::map<std::string, Attempts>
      attempts_; /**< by the name, or by its beginning if it is too long for one */
};

}  // namespace interlock::web
