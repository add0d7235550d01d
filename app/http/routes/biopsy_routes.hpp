/**
 * @file
 * Routes of Cooperative Biopsy: forces and their zero, membranes, images.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class BiopsyRoutes {
 public:
  /** Both must outlive it. */
  BiopsyRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply show() const;
  [[nodiscard]] tl::expected<void, Problem> need_needle() const;
  [[nodiscard]] tl::expected<void, Problem> need_closed() const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_membranes(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> reset_membranes(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> zero(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<void, Problem>> announce(const Call& call,
                                                                             nlohmann::json detail) const;
  [[nodiscard]] Reply take_image(const Call& call) const;
  [[nodiscard]] Reply show_image(const nlohmann::json& body) const;

  const Context& context_;
};

}  // namespace interlock::web
