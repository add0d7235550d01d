#include "tuning/step_rig.hpp"

#include <algorithm>

#include "plant/exchange.hpp"
#include "robot/catalog.hpp"

namespace interlock {
namespace {

/** Longer than pedal debouncing, switch bounce and settling take. */
constexpr std::uint32_t time_to_settle_ms = 200;
constexpr std::uint32_t holder = 1;

std::string at(const char* what, catalog::Family family, std::uint32_t code) {
  return std::string(what) + catalog::name(family, code);
}

}  // namespace

StepRig::StepRig(const ilk_config_t& config, const plant::Parameters& parameters, std::uint64_t seed,
                 std::uint32_t slot)
    : config_(config),
      slot_(slot),
      settle_ticks_(time_to_settle_ms * 1000 / config.common.period_us +
                    std::max(config.common.power_up_ticks, config.axis[slot].rest_ticks)),
      plant_(config, parameters, seed) {
  requests_.reserve(ILK_REQUESTS_PER_TICK);
}

/** Enabled, with the pedal held; its home is where it stands, if it says so. */
RigResult<void> StepRig::begin_motion(bool sets_home) {
  const auto step = [&](ilk_request_kind_t kind) {
    ask(kind);
    return run(settle_ticks_);
  };
  return step(ILK_REQUEST_RESET)
      .and_then([&] { return step(ILK_REQUEST_ENABLE); })
      .and_then([&] { return sets_home ? step(ILK_REQUEST_SET_HOME) : RigResult<void>(); })
      .and_then([&] { return plant_.schedule(plant::command::PressPedal{true}).map([](std::uint64_t) {}); })
      .and_then([&] { return run(settle_ticks_); });
}

RigResult<void> StepRig::make_ready(const std::function<void(const ilk_axis_t&)>& watch) {
  if (const std::uint32_t error = ilk_init(&config_, &state_).error; error != ILK_CONFIG_ERROR_NONE) {
    return tl::unexpected(at("the kernel refuses the robot: ", catalog::Family::config_error, error));
  }
  const bool has_switch = config_.axis[slot_].limit_side != ILK_LIMIT_NONE;
  const RigResult<void> moving = run(settle_ticks_).and_then([&] { return begin_motion(!has_switch); });
  if (!moving || !has_switch) {
    return moving;
  }
  ask(ILK_REQUEST_HOME);
  for (std::uint32_t n = 0; n < config_.axis[slot_].home_timeout_ticks && axis().homed == 0; ++n) {
    if (const RigResult<void> ticked = tick(); !ticked) {
      return ticked;
    }
    watch(axis());
  }
  if (axis().homed == 0) {
    return tl::unexpected(std::string("homing did not end"));
  }
  return run(settle_ticks_);
}

/** A MOVE without drive is refused: the lease of the one before ends by one of a single tick. */
void StepRig::move(std::int32_t target_counts, std::uint32_t drive) {
  if (drive == 0 && !may_drive_) {
    return;
  }
  may_drive_ = drive != 0;
  ilk_request_t request{};
  request.kind = ILK_REQUEST_MOVE;
  request.axis = slot_;
  request.target_counts = target_counts;
  request.drive = std::max(drive, 1U);
  request.amplitude = may_drive_ ? config_.axis[slot_].max_amplitude : 0;
  request.lease_ticks = may_drive_ ? config_.common.lease_max_ticks : 1;
  request.consent = state_.system.consent;
  put(request);
}

RigResult<void> StepRig::tick() {
  ilk_request_t heartbeat{};
  heartbeat.kind = ILK_REQUEST_HEARTBEAT;
  heartbeat.holder = holder;
  put(heartbeat);
  const ilk_inputs_t inputs = plant::exchange(plant_, outputs_, state_.system.tick);
  ilk_step(&config_, &state_, &inputs, requests_.data(), static_cast<std::uint32_t>(requests_.size()),
           &outputs_);
  requests_.clear();
  return judge();
}

RigResult<void> StepRig::judge() const {
  if (axis().state == ILK_AXIS_FAULTED) {
    return tl::unexpected(at("the axis faulted: ", catalog::Family::fault, axis().fault));
  }
  for (std::uint32_t n = 0; n < outputs_.verdict_count; ++n) {
    const ilk_verdict_record_t& record = outputs_.verdict[n];
    if (record.verdict != ILK_VERDICT_ACCEPTED) {
      return tl::unexpected(at("the kernel refuses ", catalog::Family::request, record.kind) +
                            at(": ", catalog::Family::verdict, record.verdict));
    }
  }
  return {};
}

void StepRig::put(ilk_request_t request) {
  request.sequence = ++sequence_;
  request.crc = ilk_request_crc(&request);
  requests_.push_back(request);
}

void StepRig::ask(ilk_request_kind_t kind) {
  ilk_request_t request{};
  request.kind = kind;
  request.axis = slot_;
  request.consent = state_.system.consent;
  put(request);
}

RigResult<void> StepRig::run(std::uint32_t ticks) {
  for (std::uint32_t n = 0; n < ticks; ++n) {
    if (RigResult<void> ticked = tick(); !ticked) {
      return ticked;
    }
  }
  return {};
}

}  // namespace interlock
