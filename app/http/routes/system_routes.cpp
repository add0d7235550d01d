#include "http/routes/system_routes.hpp"

#include <spdlog/spdlog.h>

#include "http/problems.hpp"
#include "http/status_json.hpp"
#include "robot/catalog.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

}  // namespace

SystemRoutes::SystemRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/status", anybody, [this](const Call&) -> Answering { co_return status(); });
  router.add(verb::post, "/api/stop", anybody, [this](const Call&) { return stop(); });
  router.add(verb::post, "/api/reset", holder,
             [this](const Call&) { return context_.ask_kernel(ILK_REQUEST_RESET, 0, "reset"); });
  router.add(verb::get, "/api/stream", viewers, [](const Call&) -> Answering {
    co_return fail({.status = Status::upgrade_required,
                    .code = "UPGRADE_REQUIRED",
                    .detail = "The stream is a WebSocket.",
                    .expected = "Upgrade: websocket",
                    .next_step = "Open it with a WebSocket client."});
  });
}

Reply SystemRoutes::status() const {
  return Success{Status::ok, status_json(context_.robot, context_.config, context_.view(),
                                         std::chrono::steady_clock::now())};
}

Answering SystemRoutes::stop() const {
  spdlog::warn("STOP");
  context_.book.abort_all("STOP.");
  const auto answer = co_await context_.control.stop();
  json body{{"verdict", nullptr}, {"tick", nullptr}};
  if (answer && answer->verdict) {
    body["verdict"] = catalog::name(catalog::Family::verdict, *answer->verdict);
    body["tick"] = answer->tick;
  }
  co_return Success{Status::ok, std::move(body)};
}

}  // namespace interlock::web
