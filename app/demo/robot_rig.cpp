#include "demo/robot_rig.hpp"

#include <algorithm>

#include "plant/exchange.hpp"
#include "robot/catalog.hpp"

namespace interlock {
namespace {

/** Longer than debouncing, bounce and settling take. */
constexpr double settle_s = 0.2;
/** Longer than homing of either robot takes, or the longest way. */
constexpr double patience_s = 1800.0;
constexpr std::uint32_t holder = 1;

tl::unexpected<std::string> failed(std::string what) { return tl::unexpected(std::move(what)); }

std::string ended(const Robot& robot, std::uint32_t slot, const OrderStatus& status) {
  const Axis* axis = robot.at_slot(slot);
  return (axis == nullptr ? "the robot" : axis->name) + ": the order ended in phase " +
         std::to_string(static_cast<int>(status.phase)) + " for reason " +
         std::to_string(static_cast<int>(status.reason)) + ", code " + std::to_string(status.code);
}

}  // namespace

RobotRig::RobotRig(const Robot& robot, const ilk_config_t& config, const plant::Parameters& parameters,
                   std::uint64_t seed)
    : robot_(robot),
      config_(config),
      plant_(config, parameters, seed),
      conductor_(RobotPlan(robot, config)) {}

DemoResult<void> RobotRig::make_ready() {
  return start().and_then([this] { return home(); });
}

DemoResult<void> RobotRig::start() {
  const ilk_config_verdict_t verdict = ilk_init(&config_, &state_);
  if (verdict.error != ILK_CONFIG_ERROR_NONE) {
    return failed("the kernel refuses the robot: " +
                  catalog::name(catalog::Family::config_error, verdict.error));
  }
  run(ticks_of(settle_s));
  DemoResult<void> done = ask(ILK_REQUEST_RESET, nullptr);
  for (const Axis& axis : robot_.axes) {
    if (axis.limit == ILK_LIMIT_NONE) {
      done = done.and_then([&] { return ask(ILK_REQUEST_SET_HOME, &axis); });
    }
    done = done.and_then([&] { return ask(ILK_REQUEST_ENABLE, &axis); });
  }
  return done;
}

/** Presses again as often as a step asks for it. */
DemoResult<void> RobotRig::home() {
  const auto steps = static_cast<std::uint32_t>(robot_.home_steps.size());
  conductor_.take(HomeOrder{++proposal_, 0, steps, 0, 0}, state_.tick);
  set_pedal(true);
  const std::uint32_t begun = state_.tick;
  while (is_open(conductor_.home().order.phase) && state_.tick - begun < ticks_of(patience_s)) {
    tick();
    if (conductor_.home().order.reason == OrderReason::press_again) {
      set_pedal(false);
      set_pedal(true);
    }
  }
  set_pedal(false);
  const HomeStatus& status = conductor_.home();
  return status.order.phase == OrderPhase::done ? DemoResult<void>()
                                                : failed(ended(robot_, status.slot, status.order));
}

DemoResult<void> RobotRig::carry_out(const PathProgram& program) {
  conductor_.take(PathOrder{++proposal_, &program, 0}, state_.tick);
  set_pedal(true);
  const std::uint32_t begun = state_.tick;
  while (is_open(conductor_.path().order.phase) && state_.tick - begun < ticks_of(patience_s)) {
    tick();
  }
  const PathStatus status = conductor_.path();
  conductor_.end(proposal_, OrderReason::cancelled, state_.tick);
  set_pedal(false);
  return status.order.phase == OrderPhase::done ? DemoResult<void>()
                                                : failed(ended(robot_, status.slot, status.order));
}

AxisPositions RobotRig::true_positions() const {
  AxisPositions positions;
  for (const Axis& axis : robot_.axes) {
    positions.push_back(plant_.station(axis.slot)->position_counts() / axis.counts_per_unit);
  }
  return positions;
}

double RobotRig::time_s() const { return state_.tick * static_cast<double>(config_.period_us) * 1e-6; }

std::uint32_t RobotRig::ticks_of(double seconds) const {
  return static_cast<std::uint32_t>(seconds * 1e6 / config_.period_us);
}

void RobotRig::run(std::uint32_t ticks) {
  for (std::uint32_t n = 0; n < ticks; ++n) {
    tick();
  }
}

void RobotRig::set_pedal(bool pressed) {
  static_cast<void>(plant_.schedule(plant::command::PressPedal{pressed}));
  run(ticks_of(settle_s));
}

/** One request that the kernel must accept. */
DemoResult<void> RobotRig::ask(ilk_request_kind_t kind, const Axis* axis) {
  ilk_request_t request{};
  request.kind = kind;
  request.axis = axis == nullptr ? 0 : axis->slot;
  const std::uint32_t sequence = put(request);
  tick();
  for (std::uint32_t n = 0; n < outputs_.verdict_count; ++n) {
    const ilk_verdict_record_t& record = outputs_.verdict[n];
    if (record.sequence == sequence && record.verdict != ILK_VERDICT_ACCEPTED) {
      return failed("the kernel refuses " + catalog::name(catalog::Family::request, kind) +
                    (axis == nullptr ? "" : " of " + axis->name) + ": " +
                    catalog::name(catalog::Family::verdict, record.verdict));
    }
  }
  run(ticks_of(settle_s));
  return {};
}

std::uint32_t RobotRig::put(ilk_request_t request) {
  request.sequence = ++sequence_;
  request.crc = ilk_request_crc(&request);
  requests_.push_back(request);
  return sequence_;
}

void RobotRig::tick() {
  ilk_request_t heartbeat{};
  heartbeat.kind = ILK_REQUEST_HEARTBEAT;
  heartbeat.holder = holder;
  put(heartbeat);
  const ilk_inputs_t inputs = plant::exchange(plant_, outputs_, state_.tick);
  ilk_step(&config_, &state_, &inputs, requests_.data(), static_cast<std::uint32_t>(requests_.size()),
           &outputs_);
  requests_.clear();
  settle_verdicts();
  const Wishes wishes = conductor_.tick(snapshot());
  for (const Wish& wish : wishes.all()) {
    sent_.push_back({put(request_of(wish)), wish.origin});
  }
}

void RobotRig::settle_verdicts() {
  for (std::uint32_t n = 0; n < outputs_.verdict_count; ++n) {
    const ilk_verdict_record_t& record = outputs_.verdict[n];
    const auto found = std::ranges::find(sent_, record.sequence, &Sent::sequence);
    if (found != sent_.end()) {
      conductor_.on_verdict(found->origin, record.verdict, record.tick);
      sent_.erase(found);
    }
  }
}

ilk_snapshot_t RobotRig::snapshot() const {
  ilk_snapshot_t snapshot{};
  snapshot.clock = ILK_CLOCK_SIM;
  snapshot.simulated = 1;
  snapshot.period_us = config_.period_us;
  snapshot.config_crc = config_.crc;
  snapshot.state = state_;
  std::copy(std::begin(outputs_.command), std::end(outputs_.command), snapshot.command);
  std::copy(std::begin(outputs_.gate), std::end(outputs_.gate), snapshot.gate);
  return snapshot;
}

}  // namespace interlock
