/**
 * @file
 * Slows down whoever guesses passwords, and keeps nobody out.
 *
 * After wrong passwords an attempt waits before it is judged: for at most `longest_delay`, and then it is
 * judged. So the right password always opens a session, a few seconds later at worst, however many wrong ones
 * came before it. What waits is the address and the pair of address and name, never the name: guesses from
 * one address do not delay the owner of the name at another.
 *
 * Few attempts may wait or be judged at the same time, `pair_places` for a pair and `address_places` for an
 * address; one more is refused. Together with the delay this bounds the rate of guesses: one a second for a
 * pair, four a second for an address.
 *
 * Behind an SSH tunnel everybody has the address of the loopback interface, so that a flood of attempts could
 * take all places of a pair. A browser in which somebody has logged in has a place of its own: it keeps a
 * token that counts as an address, for the user who logged in and nobody else. Wrong passwords delay that
 * browser, too; after `free_attempts_of_browser` of them its token counts for nothing.
 *
 * The tables hold `capacity` entries each. Beyond that, those whose last attempt is oldest are forgotten.
 */
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "service/clocks.hpp"

namespace interlock {

class LoginGuard {
  struct Tables;

 public:
  static constexpr std::size_t capacity = 4096;
  static constexpr std::size_t pair_places = 4;
  static constexpr std::size_t address_places = 16;
  static constexpr unsigned free_attempts_of_browser = 10;
  static constexpr std::chrono::seconds longest_delay{4};
  /** Wrong passwords count until none has come for as long. */
  static constexpr std::chrono::minutes memory{10};

  /** Who tries to log in as whom. */
  struct Source {
    std::string address; /**< without port */
    std::string name;
    std::string token; /**< of the browser; empty: it has none */
  };

  /**
   * An attempt that waits or is judged. It counts as wrong until it turns out right, so that many at the same
   * time gain nothing. One that ends without a judgement does not count. It may outlive its guard.
   */
  class Attempt {
   public:
    Attempt(Attempt&&) noexcept = default;
    Attempt& operator=(Attempt&&) = delete;
    ~Attempt();

    /** How long it has to wait before it is judged. */
    [[nodiscard]] std::chrono::seconds delay() const { return delay_; }

    /** Its password was checked. */
    void judged(bool right);

   private:
    friend class LoginGuard;
    Attempt(std::shared_ptr<Tables> tables, std::string address, std::string pair);

    std::shared_ptr<Tables> tables_; /**< none after a move */
    std::string address_;            /**< key of its table; empty: of a browser that is known */
    std::string pair_;
    std::chrono::seconds delay_{0};
    bool judged_ = false;
  };

  LoginGuard();

  /** An attempt begins; nothing when too many of that address or pair are under way. */
  [[nodiscard]] std::optional<Attempt> begin(const Source& source, SteadyTime now);

  /** Somebody logged in with a browser that shall be known by that token. */
  void know(const std::string& token, const std::string& name, SteadyTime now);

 private:
  std::shared_ptr<Tables> tables_;
};

}  // namespace interlock
