/**
 * @file
 * Routes of the axes.
 */
#pragma once

#include "http/context.hpp"
#include "http/router.hpp"

namespace interlock::web {

class MotorRoutes {
 public:
  /** Both must outlive it. */
  MotorRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply motors() const;
  [[nodiscard]] Reply motor(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> act(const Call& call) const;
  [[nodiscard]] tl::expected<const Axis*, Problem> axis_of(const std::string& slot_or_name) const;

  const Context& context_;
};

}  // namespace interlock::web
