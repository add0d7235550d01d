/**
 * @file
 * Routes of the robot as its file describes it, and of its modes.
 */
#pragma once

#include "http/context.hpp"
#include "http/proposing.hpp"
#include "http/router.hpp"

namespace interlock::web {

/** Schema `ModeAnswer` of spec/openapi.yaml. */
nlohmann::json mode_json(const Robot& robot, std::string_view mode);

class ModeRoutes {
 public:
  /** Both must outlive it. */
  ModeRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply robots() const;
  [[nodiscard]] Reply mode() const;
  [[nodiscard]] tl::expected<std::string, Problem> wanted_mode(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_mode(const Call& call) const;
  [[nodiscard]] tl::expected<Task, Problem> task_for(RobotMode mode, const std::string& author) const;
  [[nodiscard]] Reply go_manual() const;

  const Context& context_;
};

}  // namespace interlock::web
