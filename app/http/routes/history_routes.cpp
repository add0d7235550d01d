#include <limits>

#include "http/message.hpp"
#include "http/routes.hpp"
#include "motion/axis_plan.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** Its answer is written in a few milliseconds. */
constexpr std::int64_t longest_capture_s = 10;
/** Up to which each whole number is exact in JavaScript. */
constexpr std::int64_t largest_number = 9'007'199'254'740'991;

Problem no_black_box(const std::string& reason) {
  return {.status = Status::service_unavailable,
          .code = "NO_BLACK_BOX",
          .detail = "The kernel's black box cannot be read: " + reason + ".",
          .expected = "a kernel with a black box, and the app told of it with --black-box",
          .next_step = "Start the robot with `interlock run`."};
}

tl::expected<CaptureSpan, Problem> span_of(const json& query, const Robot& robot) {
  Fields fields(query, {"slot", "seconds", "until"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto seconds = fields.integer("seconds", 1, longest_capture_s).value_or(1);
  const auto until = fields.integer("until", 0, std::numeric_limits<std::uint32_t>::max());
  fields.require({{"slot", "slot of an axis that /api/motors lists"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  CaptureSpan span;
  span.slot = static_cast<std::uint32_t>(*slot);
  span.seconds = static_cast<std::uint32_t>(seconds);
  if (until) {
    span.until = static_cast<std::uint32_t>(*until);
  }
  if (robot.at_slot(span.slot) == nullptr) {
    return fail(invalid("slot", "Slot " + std::to_string(span.slot) + " has no axis.",
                        "slot of an axis that /api/motors lists"));
  }
  return span;
}

}  // namespace

HistoryRoutes::HistoryRoutes(const Context& context, Past past, Router& router)
    : context_(context),
      past_(std::move(past)),
      history_(std::chrono::system_clock::to_time_t(context.clock())) {
  router.add(verb::get, "/api/history", viewers,
             [this](const Call& call) -> Answering { co_return history(call); });
  router.add(verb::get, "/api/capture", viewers, [this](const Call& call) { return capture(call); });
}

void HistoryRoutes::keep(RunRecorder& runs) {
  if (past_.feed != nullptr) {
    past_.feed->take([&](const TickBucket& bucket) {
      history_.add(bucket);
      runs.add(bucket);
    });
  }
}

/** By the zeroes of now. */
std::optional<ForceScales> HistoryRoutes::force_scales() const {
  if (!context_.robot.biopsy) {
    return std::nullopt;
  }
  const Biopsy& biopsy = *context_.robot.biopsy;
  const json now = context_.biopsy.to_json(context_.control.current(), false);
  const auto scale = [&](const SensorChannel& channel, const char* force) {
    return ForceScale{channel.slope / biopsy.units_per_newton, now[force]["zero_counts"].is_null()
                                                                   ? channel.reference
                                                                   : now[force]["zero_counts"].get<double>()};
  };
  return ForceScales{scale(biopsy.hand, "hand"), scale(biopsy.needle, "needle")};
}

Reply HistoryRoutes::history(const Call& call) const {
  return known_query(call.request, {"after"}).and_then([this](const json& query) -> Reply {
    Fields fields(query, {"after"});
    const auto after = fields.integer("after", 0, largest_number).value_or(0);
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return Success{.body = history_.after(static_cast<std::uint64_t>(after), context_.robot, force_scales())};
  });
}

void HistoryRoutes::add_rules(CaptureSpan& span) const {
  const RobotPlan plan(context_.robot, context_.config);
  span.velocity = plan.axis[span.slot].control.velocity;
  if (const auto scales = force_scales(); scales && plan.needle) {
    span.forces = CapturedForces{plan.needle->force, *scales};
  }
}

Answering HistoryRoutes::capture(const Call& call) const {
  auto span = known_query(call.request, {"slot", "seconds", "until"}).and_then([this](const json& query) {
    return span_of(query, context_.robot);
  });
  if (!span) {
    co_return fail(span.error());
  }
  add_rules(*span);
  if (past_.black_box.empty()) {
    co_return fail(no_black_box("the app was not told where it is"));
  }
  auto read = [file = past_.black_box, span = *span] { return interlock::capture(file, span); };
  const auto captured = co_await context_.work.run(std::move(read));
  if (!captured) {
    co_return fail(captured.error());
  }
  co_return captured->map([](const json& body) { return Success{.body = body}; }).map_error(no_black_box);
}

}  // namespace interlock::web
