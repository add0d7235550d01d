/**
 * @file
 * Routes of the system as a whole: status, metrics, the kernel's configuration, STOP, RESET and the stream's
 * address.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class SystemRoutes {
 public:
  /** Both must outlive it. */
  SystemRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply status() const;
  [[nodiscard]] Reply configuration() const;
  [[nodiscard]] Reply metrics() const;
  [[nodiscard]] boost::asio::awaitable<Reply> stop(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
