#include "service/context.hpp"

#include <spdlog/spdlog.h>

#include "robot/catalog.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

constexpr std::chrono::milliseconds oldest_state{250};

/** The record of what somebody is about to do, who must be logged in still. */
struct Announcement {
  AuditEntry entry;
  std::uint32_t session = 0;
  Role role = Role::viewer;

  Stored<void> operator()(Store& store) const {
    return store.transact([this](Transaction& transaction) -> Stored<void> {
      return Sessions(transaction).need(session, role, entry.time).map([&](const Session&) {
        Audit(transaction).append(entry);
      });
    });
  }
};

}  // namespace

const ControlView& Context::view() const {
  const ControlView& newest = control.view();
  registry.follow(newest);
  biopsy.follow(newest);
  return newest;
}

tl::expected<void, Problem> Context::need_kernel() const {
  if (!view().attached) {
    return fail(no_kernel("No kernel is connected."));
  }
  return {};
}

tl::expected<void, Problem> Context::need_present_state() const {
  return need_kernel().and_then([this]() -> tl::expected<void, Problem> {
    const auto age = std::chrono::duration_cast<std::chrono::milliseconds>(steady_clock() - view().received);
    if (age > oldest_state) {
      return fail(no_kernel("The newest state of the robot is " + std::to_string(age.count()) + " ms old, " +
                            "and motion needs one of the last " + std::to_string(oldest_state.count()) +
                            " ms."));
    }
    return {};
  });
}

tl::expected<void, Problem> Context::need_control(const Caller& caller) const {
  if (motion_control.held_by(caller.session)) {
    return {};
  }
  const auto& holding = motion_control.holder();
  return fail({.status = Status::conflict,
               .code = "CONTROL",
               .detail = holding ? holding->user + " is in control, in session " +
                                       std::to_string(holding->session) + "."
                                 : "Nobody is in control.",
               .expected = "control of the robot",
               .next_step = "Request control."});
}

AuditEntry Context::entry(const Caller& caller, AuditKind kind, nlohmann::json detail) const {
  AuditEntry entry{.time = clock(),
                   .tick = std::nullopt,
                   .actor = caller.session != 0 ? caller.user : audit_actor::nobody,
                   .session = std::nullopt,
                   .kind = kind,
                   .detail = std::move(detail)};
  // Not the newest view: whoever changes a proposal is in the middle of reading this one.
  if (const ControlView& now = control.current(); now.attached) {
    entry.tick = now.snapshot.state.system.tick;
  }
  if (caller.session != 0) {
    entry.session = caller.session;
  }
  return entry;
}

void Context::record_stop(const Caller& caller, std::uint32_t unrecorded,
                          std::optional<AuditEntry> begun) const {
  const std::string& who = caller.user.empty() || caller.is_program ? caller.peer : caller.user;
  spdlog::warn("STOP by {}", who);
  if (unrecorded != 0) {
    spdlog::warn("{} STOPs came before it too fast to be recorded", unrecorded);
  }
  AuditEntry stop = entry(caller, AuditKind::stop, {{"peer", caller.peer}});
  if (begun) {
    stop.time = begun->time;
    stop.tick = begun->tick;
  }
  registry.abort_all("STOP by " + who + ".", stop.actor);
  if (caller.session == 0 || caller.is_program) {
    note(stop_records.add(std::move(stop), unrecorded, steady_clock()));
    return;
  }
  if (unrecorded != 0) {
    stop.detail["unrecorded"] = unrecorded;
  }
  store.note(std::move(stop));
}

void Context::begin_scan(const HoldSource& source) const {
  holds.begin_scan(source, clock(), steady_clock());
  registry.hold_still(true);
}

void Context::end_scan() const {
  holds.end_scan();
  registry.hold_still(false);
}

void Context::restore_holds(const nlohmann::json& kept) const {
  holds.restore(kept, clock(), steady_clock());
  registry.hold_still(holds.scanning());
}

void Context::note(std::optional<AuditEntry> entry) const {
  if (entry) {
    store.note(std::move(*entry));
  }
}

boost::asio::awaitable<tl::expected<void, Problem>> Context::record_then_recheck(
    const Caller& caller, AuditKind kind, nlohmann::json detail) const {
  const bool held = motion_control.held_by(caller.session);
  Announcement announced{entry(caller, kind, std::move(detail)), caller.session,
                         caller.role.value_or(Role::admin)};
  auto recorded = co_await store.run(std::move(announced));
  if (!recorded) {
    co_return recorded;
  }
  if (!sessions.lives(caller.session)) {
    co_return fail(login_needed());
  }
  if (kind == AuditKind::proposal && has_waited_too_long(caller.asked)) {
    co_return fail(too_late());
  }
  if (held) {
    co_return need_control(caller);
  }
  co_return recorded;
}

boost::asio::awaitable<Reply> Context::ask_kernel(const Caller& caller, std::uint32_t kind,
                                                  std::uint32_t slot, std::string where,
                                                  std::int32_t target_counts) const {
  const auto kernel = need_kernel();
  if (!kernel) {
    co_return fail(kernel.error());
  }
  nlohmann::json detail{{"request", catalog::name(catalog::Family::request, kind)}, {"what", where}};
  if (kind == ILK_REQUEST_DISABLE) {
    store.note(entry(caller, AuditKind::request, std::move(detail)));
  } else {
    const auto announced = co_await record_then_recheck(caller, AuditKind::request, std::move(detail));
    if (!announced) {
      co_return fail(announced.error());
    }
  }
  const std::uint32_t stops = control.stops();
  const auto answer = co_await control.ask(kind, slot, target_counts);
  if (answer && !answer->verdict && control.stops() != stops) {
    co_return fail(stopped_meanwhile(where));
  }
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

}  // namespace interlock
