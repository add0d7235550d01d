#include "closed_loop.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "plant/exchange.hpp"
#include "proposals/motion_kind.hpp"

namespace interlock::test {
namespace {

constexpr std::uint32_t heartbeat_ticks = 20;
constexpr std::uint32_t settle_ticks = 200;

}  // namespace

ClosedLoop::ClosedLoop(std::uint64_t seed, std::uint32_t latency, const Robot& robot)
    : ClosedLoop(seed, latency, robot, plant::default_parameters(config_of(robot))) {}

ClosedLoop::ClosedLoop(std::uint64_t seed, std::uint32_t latency, const Robot& robot,
                       const plant::Parameters& plant)
    : robot_(robot),
      config_(config_of(robot)),
      plant_(config_, plant, seed),
      modes_(make_modes(RobotPlan(robot, config_)), LinkageWatch(robot)),
      latency_(latency) {
  if (ilk_init(&config_, &state_).error != ILK_CONFIG_ERROR_NONE) {
    throw std::runtime_error("the kernel refuses the robot " + robot.name);
  }
  run(settle_ticks);
  request(ILK_REQUEST_RESET);
}

void ClosedLoop::put(ilk_request_t request) {
  request.sequence = ++sequence_;
  request.crc = ilk_request_crc(&request);
  requests_.push_back(request);
}

ilk_snapshot_t ClosedLoop::snapshot() const {
  ilk_snapshot_t snapshot{};
  snapshot.clock = ILK_CLOCK_SIM;
  snapshot.simulated = 1;
  snapshot.period_us = config_.common.period_us;
  snapshot.config_crc = config_.crc;
  snapshot.state = state_;
  snapshot.inputs = inputs_;
  std::copy(std::begin(outputs_.command), std::end(outputs_.command), snapshot.command);
  std::copy(std::begin(outputs_.gate), std::end(outputs_.gate), snapshot.gate);
  return snapshot;
}

void ClosedLoop::tick() {
  inputs_ = plant::exchange(plant_, outputs_, state_.system.tick);
  if (state_.system.tick % heartbeat_ticks == 0) {
    ilk_request_t heartbeat{};
    heartbeat.kind = ILK_REQUEST_HEARTBEAT;
    heartbeat.holder = 1;
    put(heartbeat);
  }
  most_requests_ = std::max(most_requests_, static_cast<std::uint32_t>(requests_.size()));
  ilk_step(&config_, &state_, &inputs_, requests_.data(), static_cast<std::uint32_t>(requests_.size()),
           &outputs_);
  requests_.clear();
  deliver_verdicts();
  on_their_way_.push_back(snapshot());
  if (silent_) {
    on_their_way_.clear();
  } else if (on_their_way_.size() > latency_) {
    seen_tick_ = on_their_way_.front().state.system.tick;
    const std::uint32_t consent = on_their_way_.front().state.system.consent;
    const KernelRequests requests = modes_.tick(on_their_way_.front());
    on_their_way_.pop_front();
    for (const KernelRequest& request : requests.all()) {
      put(sent_form(request, consent));
      sent_.push_back({sequence_, request.origin});
    }
  }
  subscriber_();
}

void ClosedLoop::deliver_verdicts() {
  for (std::uint32_t i = 0; i < outputs_.verdict_count; ++i) {
    const ilk_verdict_record_t& verdict = outputs_.verdict[i];
    const auto found = std::find_if(sent_.begin(), sent_.end(),
                                    [&](const Sent& each) { return each.sequence == verdict.sequence; });
    refusals_ += verdict.verdict != ILK_VERDICT_ACCEPTED && verdict.verdict != ILK_VERDICT_MODE ? 1u : 0u;
    if (found != sent_.end()) {
      modes_.on_verdict(found->origin, verdict.verdict, verdict.tick);
      sent_.erase(found);
    }
  }
}

void ClosedLoop::run(std::uint32_t ticks) {
  for (std::uint32_t i = 0; i < ticks; ++i) {
    tick();
  }
}

void ClosedLoop::happen(const plant::command::Command& command) {
  if (!plant_.schedule(command)) {
    throw std::runtime_error("the plant refuses a command");
  }
}

void ClosedLoop::pedal(bool pressed) {
  happen(plant::command::PressPedal{pressed});
  run(settle_ticks);
}

void ClosedLoop::stop() {
  modes_.end_all(TaskReason::stopped, seen_tick_);
  request(ILK_REQUEST_STOP);
}

void ClosedLoop::enable_all() {
  for (const Axis& axis : robot_.axes) {
    request(ILK_REQUEST_ENABLE, axis.slot);
  }
}

void ClosedLoop::request(std::uint32_t kind, std::uint32_t slot, std::int32_t target_counts) {
  ilk_request_t request{};
  request.kind = kind;
  request.axis = slot;
  request.target_counts = target_counts;
  request.consent = state_.system.consent;
  put(request);
  const std::uint32_t refused_before = state_.system.requests_refused;
  tick();
  if (state_.system.requests_refused != refused_before) {
    throw std::runtime_error("the kernel refused request " + std::to_string(kind));
  }
  run(settle_ticks);
}

void ClosedLoop::make_ready(std::uint32_t slot) {
  request(ILK_REQUEST_ENABLE, slot);
  if (config_.axis[slot].limit_side == ILK_LIMIT_NONE) {
    request(ILK_REQUEST_SET_HOME, slot);
    pedal(true);
    return;
  }
  pedal(true);
  request(ILK_REQUEST_HOME, slot);
  for (std::uint32_t i = 0; i < config_.axis[slot].home_timeout_ticks && state_.axis[slot].homed == 0; ++i) {
    tick();
  }
  if (state_.axis[slot].homed == 0) {
    throw std::runtime_error("homing failed");
  }
  run(latency_ + 1);
}

void ClosedLoop::make_all_ready() {
  for (const Axis& axis : robot_.axes) {
    request(ILK_REQUEST_SET_HOME, axis.slot);
  }
  enable_all();
  pedal(true);
}

TaskStatus ClosedLoop::carry_out(std::uint32_t id, const Work& work, std::uint32_t most_ticks) {
  give(id, work);
  const auto* moved = work.find<MoveTask>();
  const auto status = [&] { return moved != nullptr ? move(moved->slot) : this->status(work.type()); };
  for (std::uint32_t i = 0; i < most_ticks && is_open(status().phase); ++i) {
    tick();
  }
  return status();
}

std::uint32_t ClosedLoop::verdict_of_move(std::uint32_t slot, std::int32_t target_counts,
                                          std::uint32_t drive) {
  ilk_request_t move{};
  move.kind = ILK_REQUEST_MOVE;
  move.axis = slot;
  move.target_counts = target_counts;
  move.drive = drive;
  move.lease_ticks = 1;
  move.consent = state_.system.consent;
  put(move);
  const std::uint32_t sequence = sequence_;
  tick();
  for (std::uint32_t i = 0; i < outputs_.verdict_count; ++i) {
    if (outputs_.verdict[i].sequence == sequence) {
      return outputs_.verdict[i].verdict;
    }
  }
  throw std::runtime_error("the kernel gave no verdict");
}

}  // namespace interlock::test
