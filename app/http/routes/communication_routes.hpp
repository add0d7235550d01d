/**
 * @file
 * Routes of the connections to the app.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class CommunicationRoutes {
 public:
  /** Both must outlive it. */
  CommunicationRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> list() const;
  [[nodiscard]] boost::asio::awaitable<Reply> disconnect(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
