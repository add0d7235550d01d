#include "http/api.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "http/status_json.hpp"
#include "proposals/proposal_json.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
using nlohmann::json;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds beat_period{33};
constexpr auto as_result = asio::as_tuple(asio::use_awaitable);

}  // namespace

Api::Api(const asio::any_io_executor& executor, const Robot& robot, const ilk_config_t& config,
         Mailbox& mailbox, const std::string& bench_socket)
    : control_(executor, mailbox),
      book_(
          robot, config, [this](const Command& command) { return control_.send(command); },
          [] { return std::chrono::system_clock::now(); }),
      bench_(executor, bench_socket),
      context_{executor, robot, config, control_, book_, stream_, bench_},
      router_([](const Caller&) { return std::optional<Problem>(); }) {
  tell_of_changes();
}

void Api::tell_of_changes() {
  book_.on_change([this](const Proposal& proposal) {
    spdlog::info("proposal {}: {} to {} counts: {}: {}", proposal.id, proposal.axis,
                 proposal.move.target_counts, state_name(proposal.state), proposal.detail);
    json message = to_json(proposal);
    message["type"] = "proposal";
    stream_.send_text(message);
  });
  control_.on_orders = [this] { (void)context_.view(); };
  control_.on_event = [this](const ilk_event_t& event) {
    const json message = event_json(event);
    spdlog::info("kernel: {}", message.dump());
    stream_.send_text(message);
  };
  control_.on_events_lost = [this](const EventsLost& lost) {
    spdlog::warn("{} kernel events were lost", lost.count);
    stream_.send_text(events_lost_json(lost.count));
  };
}

Caller Api::caller_of(const Request&, const std::string& peer) { return {1, "console", Role::admin, peer}; }

OpenTargets Api::open_targets() const {
  OpenTargets targets{};
  for (const Axis& axis : context_.robot.axes) {
    if (const Proposal* open = book_.open_of(axis.slot)) {
      targets[axis.slot] = {true, open->move.target_counts};
    }
  }
  return targets;
}

asio::awaitable<void> Api::beat() {
  asio::steady_timer timer(context_.executor, steady_clock::now());
  for (;;) {
    timer.expires_at(std::max(timer.expiry() + beat_period, steady_clock::now()));
    const auto [error] = co_await timer.async_wait(as_result);
    if (error) {
      co_return;
    }
    const ControlView& seen = context_.view();
    if (!stream_.empty()) {
      stream_.send_state(encode_state(seen, context_.config, open_targets(), steady_clock::now()));
    }
    if (bench_.overdue(seen)) {
      spdlog::warn("the bench pedal was not renewed for 500 ms: released");
      asio::co_spawn(context_.executor, bench_.release_pedal(), asio::detached);
    }
  }
}

}  // namespace interlock::web
