#include <array>
#include <bit>

#include "http/routes.hpp"
#include "metrics/metrics.hpp"
#include "robot/catalog.hpp"
#include "robot/compile.hpp"
#include "service/reply.hpp"
#include "service/status_json.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

}  // namespace

SystemRoutes::SystemRoutes(const Context& context, const Broadcaster& stream, Router& router)
    : context_(context), stream_(stream) {
  router.add(verb::get, "/api/status", anybody, [this](const Call&) -> Answering { co_return status(); });
  router.add(verb::get, "/api/kernel/configuration", viewers,
             [this](const Call&) -> Answering { co_return configuration(); });
  router.add(verb::get, "/api/metrics", anybody, [this](const Call&) -> Answering { co_return metrics(); });
  router.add(verb::post, "/api/stop", anybody, [this](const Call& call) { return stop(call); });
  router.add(verb::post, "/api/reset", holder, [this](const Call& call) {
    return context_.ask_kernel(call.caller, ILK_REQUEST_RESET, 0, "reset");
  });
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
                                         context_.registry.app_mode(), std::chrono::steady_clock::now())};
}

/** Of the app's robot file; whether the kernel runs it, its CRC tells. */
Reply SystemRoutes::configuration() const {
  using Words = std::array<std::uint32_t, sizeof(ilk_config_t) / sizeof(std::uint32_t)>;
  return Success{
      .body = {{"crc", config_hash(context_.config)}, {"words", std::bit_cast<Words>(context_.config)}}};
}

Reply SystemRoutes::metrics() const {
  std::array<std::size_t, alarm_priorities> alarms{};
  for (const Alarm& alarm : context_.alarms.present()) {
    ++alarms[static_cast<std::size_t>(alarm.condition.priority)];
  }
  const AppCounts counts{.alarms = alarms,
                         .consoles = stream_.subscribers().size(),
                         .log_lines_lost = context_.log.lines_lost(),
                         .role_refusals = context_.role_refusals};
  return Success{.body = metrics_text(context_.robot, context_.config, context_.view(), counts,
                                      std::chrono::steady_clock::now()),
                 .text_type = metrics_media_type};
}

/** Of a client whose request the door did not recognise from its first bytes. */
Answering SystemRoutes::stop(const Call& call) const {
  auto stopping = context_.control.stop();
  // On its way to the kernel before anything is written, be it to a log.
  context_.record_stop(call.caller, 0);
  // No co_await within braces, which GCC 12 compiles wrongly.
  const auto answer = co_await std::move(stopping);
  co_return Success{Status::ok, stop_json(answer)};
}

}  // namespace interlock::web
