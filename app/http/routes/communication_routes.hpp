/**
 * @file
 * Routes of the connections to the app.
 */
#pragma once

#include "http/context.hpp"
#include "http/navigation.hpp"
#include "http/router.hpp"

namespace interlock::web {

class CommunicationRoutes {
 public:
  /** All must outlive it. */
  CommunicationRoutes(const Context& context, Navigation& navigation, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> list() const;
  [[nodiscard]] boost::asio::awaitable<Reply> disconnect(const Call& call) const;
  [[nodiscard]] Reply list_navigation() const;
  [[nodiscard]] boost::asio::awaitable<Reply> end_navigation(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_role(const Call& call) const;

  const Context& context_;
  Navigation& navigation_;
};

}  // namespace interlock::web
