/**
 * @file
 * Routes that save, compare and set the positions of several axes.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class PositionRoutes {
 public:
  /** Both must outlive it. */
  PositionRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply save() const;
  [[nodiscard]] Reply compare(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> restore(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> zero_all(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
