#include "service/bench.hpp"

#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

Problem no_bench() {
  return {.status = Status::not_found,
          .code = "NO_BENCH",
          .detail = "The hardware of this robot is not simulated.",
          .next_step = "Start interlock-app with --bench SOCKET beside interlock-sim."};
}

Problem pedal_lapsed(const std::string& why) {
  return {.status = Status::conflict,
          .code = "PEDAL_LAPSED",
          .detail = "The bench pedal is not held. " + why,
          .next_step = "Press it again."};
}

Problem bench_problem(const BenchError& error) {
  if (error.kind == BenchError::Kind::refused) {
    return invalid("", error.detail, "a command of models/plant/README.md with its fields");
  }
  return {.status = Status::service_unavailable,
          .code = "NO_BENCH",
          .detail = error.detail,
          .next_step = "Start interlock-sim, or look at its log."};
}

}  // namespace

Bench::Bench(const boost::asio::any_io_executor& executor, const std::string& socket_path) {
  if (!socket_path.empty()) {
    client_.emplace(executor, socket_path);
  }
}

tl::expected<void, Problem> Bench::need_simulated() const {
  if (!client_) {
    return fail(no_bench());
  }
  return {};
}

boost::asio::awaitable<Reply> Bench::command(std::string name, json fields, const ControlView& view,
                                             std::uint32_t session) {
  if (const auto simulated = need_simulated(); !simulated) {
    co_return fail(simulated.error());
  }
  if (name == "pedal") {
    const auto taken = take_pedal(fields, view, session);
    if (!taken) {
      co_return fail(taken.error());
    }
  }
  fields["command"] = std::move(name);
  const BenchReply reply = co_await client_->command(std::move(fields));
  if (!reply) {
    co_return fail(bench_problem(reply.error()));
  }
  co_return Success{Status::ok, *reply};
}

/** Starts, renews or ends the hold; `renew` is the app's own field, which the plant does not know. */
tl::expected<void, Problem> Bench::take_pedal(json& fields, const ControlView& view, std::uint32_t session) {
  const json renew = fields.value("renew", json(false));
  fields.erase("renew");
  if (!renew.is_boolean()) {
    return fail(invalid("renew", "renew is no boolean.", "true or false"));
  }
  if (fields.value("pressed", json()) != json(true)) {
    if (pedal_.held()) {
      came_up_ = "Session " + std::to_string(session) + " released it.";
    }
    pedal_.release();
    return {};
  }
  if (renew == json(true) && !pedal_.held()) {
    return fail(pedal_lapsed(came_up_));
  }
  pedal_.hold(view.moment(steady_clock::now()));
  presser_ = session;
  return {};
}

boost::asio::awaitable<std::optional<UtcTime>> Bench::connected_since() {
  if (!client_) {
    co_return std::nullopt;
  }
  json status{{"command", "status"}};
  (void)co_await client_->command(std::move(status));
  co_return client_->since();
}

boost::asio::awaitable<void> Bench::release_pedal(std::string why) {
  if (pedal_.held()) {
    pedal_.release();
    came_up_ = std::move(why);
    json release{{"command", "pedal"}, {"pressed", false}};
    (void)co_await client_->command(std::move(release));
  }
}

bool Bench::overdue(const ControlView& view) const {
  return pedal_.overdue(view.moment(steady_clock::now()));
}

}  // namespace interlock
