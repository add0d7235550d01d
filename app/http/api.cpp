#include "http/api.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <charconv>
#include <limits>

#include "http/fields.hpp"
#include "http/status_json.hpp"
#include "proposals/proposal_json.hpp"
#include "robot/catalog.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using nlohmann::json;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds beat_period{33};
constexpr auto as_result = asio::as_tuple(asio::use_awaitable);
constexpr const char* author = "console";

tl::unexpected<Problem> fail(Problem problem) { return tl::make_unexpected(std::move(problem)); }

Problem not_found(const std::string& what, const std::string& expected) {
  return {Status::not_found, "NOT_FOUND", "There is no " + what + ".", "", expected, "", ""};
}

Problem no_kernel(const std::string& detail) {
  return {Status::service_unavailable,
          "NO_KERNEL",
          detail,
          "",
          "",
          "Start interlock-kernel, or look at its log; the app attaches by itself.",
          ""};
}

Problem refused(const Refusal& refusal) {
  const Status status = refusal.code == "OVERLOADED" ? Status::service_unavailable : Status::conflict;
  return {status, refusal.code, refusal.detail, "", refusal.expected, refusal.next_step, ""};
}

Problem no_bench() {
  return {Status::not_found,
          "NO_BENCH",
          "The hardware of this robot is not simulated.",
          "",
          "",
          "Start interlock-app with --bench SOCKET beside interlock-sim.",
          ""};
}

Problem pedal_lapsed() {
  return {Status::conflict,
          "PEDAL_LAPSED",
          "The bench pedal came up, as its hold was not renewed for 500 ms.",
          "",
          "",
          "Press it again.",
          ""};
}

std::optional<std::uint32_t> number_in(const std::string& text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional(number) : std::nullopt;
}

std::optional<std::uint32_t> request_of_action(const std::string& action) {
  constexpr std::pair<const char*, std::uint32_t> actions[] = {{"enable", ILK_REQUEST_ENABLE},
                                                               {"disable", ILK_REQUEST_DISABLE},
                                                               {"clear-fault", ILK_REQUEST_CLEAR_FAULT},
                                                               {"home", ILK_REQUEST_HOME},
                                                               {"set-home", ILK_REQUEST_SET_HOME}};
  for (const auto& [name, request] : actions) {
    if (action == name) {
      return request;
    }
  }
  return std::nullopt;
}

/** Reads a `ProposalDraft`. */
tl::expected<MoveDraft, Problem> draft_of(const json& body, const Robot& robot) {
  constexpr std::int64_t lowest = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t highest = std::numeric_limits<std::int32_t>::max();
  Fields fields(body, {"slot", "target", "target_counts", "drive"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto target = fields.number("target");
  auto target_counts = fields.integer("target_counts", lowest, highest);
  const auto drive = fields.integer("drive", 1, highest);
  if (!fields.has("slot")) {
    fields.reject("slot", "is missing", "an integer from 0 to " + std::to_string(ILK_SLOTS - 1));
  }
  if (fields.has("target") == fields.has("target_counts")) {
    fields.reject("target", "and target_counts: one is needed, not both",
                  "target in the axis' unit, or target_counts");
  }
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  const Axis* axis = robot.at_slot(static_cast<std::uint32_t>(*slot));
  if (axis == nullptr) {
    return fail(not_found("axis in slot " + std::to_string(*slot), "a slot that /api/motors lists"));
  }
  if (target) {
    const auto counts = axis->to_counts(*target);
    if (!counts) {
      fields.reject("target", "is beyond every encoder",
                    "a position within the range that /api/motors shows");
      return fail(*fields.problem());
    }
    target_counts = *counts;
  }
  MoveDraft draft{axis->slot, static_cast<std::int32_t>(*target_counts), std::nullopt, author};
  if (drive) {
    draft.drive = static_cast<std::uint32_t>(*drive);
  }
  return draft;
}

}  // namespace

Api::Api(const asio::any_io_executor& executor, const Robot& robot, const ilk_config_t& config,
         Mailbox& mailbox, const std::string& bench_socket)
    : executor_(executor),
      robot_(robot),
      config_(config),
      control_(executor, mailbox),
      book_(
          robot, config, [this](const Command& command) { return control_.send(command); },
          [] { return std::chrono::system_clock::now(); }) {
  if (!bench_socket.empty()) {
    bench_.emplace(executor, bench_socket);
  }
  book_.on_change([this](const Proposal& proposal) {
    spdlog::info("proposal {}: {} to {} counts: {}: {}", proposal.id, proposal.axis,
                 proposal.move.target_counts, state_name(proposal.state), proposal.detail);
    json message = to_json(proposal);
    message["type"] = "proposal";
    stream_.send_text(message);
  });
  control_.on_orders = [this] { view(); };
  control_.on_event = [this](const ilk_event_t& event) {
    const json message = event_json(event);
    spdlog::info("kernel: {}", message.dump());
    stream_.send_text(message);
  };
  control_.on_events_lost = [this](const EventsLost& lost) {
    spdlog::warn("{} kernel events were lost", lost.count);
    stream_.send_text(events_lost_json(lost.count));
  };
  add_routes();
  add_bench_routes();
}

void Api::add_routes() {
  using http::verb;
  router_.add(verb::get, "/api/status", [this](auto&, auto&) -> Answering { co_return status(); });
  router_.add(verb::get, "/api/motors", [this](auto&, auto&) -> Answering { co_return motors(); });
  router_.add(verb::get, "/api/motors/{slot}", [this](auto&, auto& in) -> Answering { co_return motor(in); });
  router_.add(verb::post, "/api/motors/{slot}/{action}",
              [this](auto&, auto& in) { return act_on_motor(in); });
  router_.add(verb::get, "/api/proposals", [this](auto&, auto&) -> Answering { co_return proposals(); });
  router_.add(verb::post, "/api/proposals",
              [this](auto& request, auto&) -> Answering { co_return propose(request); });
  router_.add(verb::get, "/api/proposals/{id}",
              [this](auto&, auto& in) -> Answering { co_return proposal(in); });
  router_.add(verb::post, "/api/proposals/{id}/abort",
              [this](auto&, auto& in) -> Answering { co_return abort(in); });
  router_.add(verb::post, "/api/stop", [this](auto&, auto&) { return stop(); });
  router_.add(verb::post, "/api/reset", [this](auto&, auto&) { return reset(); });
  router_.add(verb::get, "/api/stream", [](auto&, auto&) -> Answering {
    co_return fail({Status::upgrade_required, "UPGRADE_REQUIRED", "The stream is a WebSocket.", "",
                    "Upgrade: websocket", "Open it with a WebSocket client.", ""});
  });
}

void Api::add_bench_routes() {
  router_.add(http::verb::get, "/api/bench", [this](auto&, auto&) { return bench_status(); });
  router_.add(http::verb::post, "/api/bench/{command}",
              [this](auto& request, auto& in) { return bench_command(request, in); });
}

/** The newest view; what it says of orders is in the book before anybody reads the book. */
const ControlView& Api::view() {
  const ControlView& newest = control_.view();
  book_.follow(newest);
  return newest;
}

Reply Api::status() { return Success{Status::ok, status_json(robot_, config_, view(), steady_clock::now())}; }

tl::expected<void, Problem> Api::need_kernel() {
  if (!view().attached) {
    return fail(no_kernel("No kernel is connected."));
  }
  return {};
}

tl::expected<const Axis*, Problem> Api::axis_of(const std::string& slot) const {
  const auto number = number_in(slot);
  const Axis* axis = number ? robot_.at_slot(*number) : nullptr;
  if (axis == nullptr) {
    return fail(not_found("axis in slot " + slot, "a slot that /api/motors lists"));
  }
  return axis;
}

Reply Api::motors() {
  return need_kernel().map([this] {
    const ControlView& now = view();
    json motors = json::array();
    for (const Axis& axis : robot_.axes) {
      motors.push_back(motor_json(axis, config_, now, book_.open_of(axis.slot)));
    }
    return Success{Status::ok, std::move(motors)};
  });
}

Reply Api::motor(const Parameters& parameters) {
  return axis_of(parameters[0]).and_then([this](const Axis* axis) -> Reply {
    return need_kernel().map([&] {
      const ControlView& now = view();
      return Success{Status::ok, motor_json(*axis, config_, now, book_.open_of(axis->slot))};
    });
  });
}

Api::Answering Api::act_on_motor(const Parameters& parameters) {
  const auto axis = axis_of(parameters[0]);
  if (!axis) {
    co_return fail(axis.error());
  }
  const auto request = request_of_action(parameters[1]);
  if (!request) {
    co_return fail(not_found("action " + parameters[1], "enable, disable, clear-fault, home or set-home"));
  }
  co_return co_await ask(*request, (*axis)->slot, (*axis)->name + " " + parameters[1]);
}

Api::Answering Api::reset() { return ask(ILK_REQUEST_RESET, 0, "reset"); }

Api::Answering Api::ask(std::uint32_t kind, std::uint32_t slot, std::string where) {
  const auto kernel = need_kernel();
  if (!kernel) {
    co_return fail(kernel.error());
  }
  const auto answer = co_await control_.ask(kind, slot);
  if (!answer || !answer->verdict) {
    co_return fail(no_kernel("The kernel did not answer within a second."));
  }
  if (*answer->verdict != ILK_VERDICT_ACCEPTED) {
    co_return fail(refused(verdict_refusal(*answer->verdict, where)));
  }
  co_return Success{
      Status::ok,
      {{"verdict", catalog::name(catalog::Family::verdict, *answer->verdict)}, {"tick", answer->tick}}};
}

Reply Api::proposals() {
  view();
  json list = json::array();
  for (const Proposal& each : book_.newest_first()) {
    list.push_back(to_json(each));
  }
  return Success{Status::ok, std::move(list)};
}

Reply Api::propose(const Request& request) {
  return parse_body(request)
      .and_then([this](const json& body) { return draft_of(body, robot_); })
      .and_then([this](const MoveDraft& draft) -> Reply {
        return need_kernel().and_then([&]() -> Reply {
          return book_.propose(draft, view())
              .map([](const Proposal& made) { return Success{Status::created, to_json(made)}; })
              .map_error(refused);
        });
      });
}

Reply Api::proposal(const Parameters& parameters) {
  view();
  const auto id = number_in(parameters[0]);
  const Proposal* found = id ? book_.find(*id) : nullptr;
  if (found == nullptr) {
    return fail(not_found("proposal " + parameters[0], "an id that /api/proposals lists"));
  }
  return Success{Status::ok, to_json(*found)};
}

Reply Api::abort(const Parameters& parameters) {
  return proposal(parameters).and_then([&](const Success&) -> Reply {
    return book_.abort(*number_in(parameters[0]))
        .map([](const Proposal& ended) { return Success{Status::ok, to_json(ended)}; })
        .map_error(refused);
  });
}

Api::Answering Api::stop() {
  spdlog::warn("STOP");
  book_.abort_all("STOP.");
  const auto answer = co_await control_.stop();
  json body{{"verdict", nullptr}, {"tick", nullptr}};
  if (answer && answer->verdict) {
    body["verdict"] = catalog::name(catalog::Family::verdict, *answer->verdict);
    body["tick"] = answer->tick;
  }
  co_return Success{Status::ok, std::move(body)};
}

Api::Answering Api::bench_status() { return pass_to_bench("status", json::object()); }

Api::Answering Api::bench_command(const Request& request, const Parameters& parameters) {
  if (!bench_) {
    co_return fail(no_bench());
  }
  auto body = parse_body(request);
  if (!body) {
    co_return fail(body.error());
  }
  if (!body->is_object() || body->contains("command") || body->contains("id")) {
    co_return fail({Status::unprocessable_entity, "INVALID",
                    "The body must be an object without command and id.", body->is_object() ? "command" : "",
                    "the fields of models/plant/README.md", "", ""});
  }
  co_return co_await pass_to_bench(parameters[0], std::move(*body));
}

/** Starts, renews or ends the hold; `renew` is the app's own field, which the plant does not know. */
tl::expected<void, Problem> Api::take_pedal(json& body) {
  const json renew = body.value("renew", json(false));
  body.erase("renew");
  if (!renew.is_boolean()) {
    return fail(
        {Status::unprocessable_entity, "INVALID", "renew is no boolean.", "renew", "true or false", "", ""});
  }
  if (body.value("pressed", json()) != json(true)) {
    pedal_.release();
    return {};
  }
  if (renew == json(true) && !pedal_.held()) {
    return fail(pedal_lapsed());
  }
  pedal_.hold(view(), steady_clock::now());
  return {};
}

Api::Answering Api::pass_to_bench(std::string command, json body) {
  if (!bench_) {
    co_return fail(no_bench());
  }
  if (command == "pedal") {
    const auto taken = take_pedal(body);
    if (!taken) {
      co_return fail(taken.error());
    }
  }
  body["command"] = std::move(command);
  const BenchReply reply = co_await bench_->command(std::move(body));
  if (!reply) {
    const bool wrong = reply.error().kind == BenchError::Kind::refused;
    co_return fail({wrong ? Status::unprocessable_entity : Status::service_unavailable,
                    wrong ? "INVALID" : "NO_BENCH", reply.error().detail, "", "",
                    wrong ? "" : "Start interlock-sim, or look at its log.", ""});
  }
  co_return Success{Status::ok, *reply};
}

asio::awaitable<void> Api::release_pedal() {
  if (pedal_.held()) {
    json release{{"pressed", false}};
    (void)co_await pass_to_bench("pedal", std::move(release));
  }
}

OpenTargets Api::open_targets() const {
  OpenTargets targets{};
  for (const Axis& axis : robot_.axes) {
    if (const Proposal* open = book_.open_of(axis.slot)) {
      targets[axis.slot] = {true, open->move.target_counts};
    }
  }
  return targets;
}

asio::awaitable<void> Api::beat() {
  asio::steady_timer timer(executor_, steady_clock::now());
  for (;;) {
    timer.expires_at(std::max(timer.expiry() + beat_period, steady_clock::now()));
    const auto [error] = co_await timer.async_wait(as_result);
    if (error) {
      co_return;
    }
    const ControlView& seen = view();
    if (!stream_.empty()) {
      stream_.send_state(encode_state(seen, config_, open_targets(), steady_clock::now()));
    }
    if (pedal_.overdue(seen, steady_clock::now())) {
      spdlog::warn("the bench pedal was not renewed for 500 ms: released");
      asio::co_spawn(executor_, release_pedal(), asio::detached);
    }
  }
}

}  // namespace interlock::web
