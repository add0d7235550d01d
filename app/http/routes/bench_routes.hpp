/**
 * @file
 * Routes of the simulated hardware.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class BenchRoutes {
 public:
  /** Both must outlive it. */
  BenchRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> status(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> command(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
