/**
 * @file
 * Routes of the app's log.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class LogRoutes {
 public:
  /** Both must outlive it. */
  LogRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply lines(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_level(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> acknowledge(const Call& call) const;
  [[nodiscard]] tl::expected<std::vector<LogLine>, Problem> unanswered(
      const std::vector<std::uint64_t>& sequences) const;
  [[nodiscard]] Success answer(const std::vector<LogLine>& lines) const;

  const Context& context_;
};

}  // namespace interlock::web
