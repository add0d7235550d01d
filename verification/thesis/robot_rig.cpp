#include "robot_rig.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>

#include "needle/scene.hpp"
#include "plant/exchange.hpp"
#include "robot/catalog.hpp"

namespace interlock {
namespace {

/** Longer than debouncing, bounce and settling take. */
constexpr double settle_s = 0.2;
/** Longer than homing of either robot takes, or the longest way. */
constexpr double timeout_s = 1800.0;
constexpr std::uint32_t holder = 1;
/** A hand in the middle of those of models/needle. */
constexpr double hand_n = 4.5;
constexpr double record_period_s = 0.005;

tl::unexpected<std::string> failed(std::string what) { return tl::unexpected(std::move(what)); }

std::string ended(const Robot& robot, const TaskStatus& status) {
  const Axis* axis = robot.at_slot(status.slot);
  return (axis == nullptr ? "the robot" : axis->name) + ": the task ended in phase " +
         std::to_string(static_cast<int>(status.phase)) + " for reason " +
         std::to_string(static_cast<int>(status.reason)) + ", code " + std::to_string(status.code);
}

}  // namespace

RobotRig::RobotRig(const Robot& robot, const ilk_config_t& config, const plant::Parameters& parameters,
                   std::uint64_t seed)
    : robot_(robot),
      config_(config),
      parameters_(parameters),
      plant_(config, parameters, seed),
      modes_(RobotPlan(robot, config)) {}

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
  begin_task(HomeTask{0, static_cast<std::uint32_t>(robot_.home_steps.size()), {}});
  const std::uint32_t begun = state_.system.tick;
  while (goes_on(begun)) {
    tick();
    if (status().reason == TaskReason::press_again) {
      set_pedal(false);
      set_pedal(true);
    }
  }
  return end_task();
}

DemoResult<void> RobotRig::carry_out(const PathProgram& program) {
  begin_record();
  begin_task(PathTask{std::make_shared<const PathProgram>(program)});
  const std::uint32_t begun = state_.system.tick;
  while (goes_on(begun)) {
    tick();
  }
  return end_task();
}

DemoResult<NeedleInsertion> RobotRig::take_biopsy(const Eigen::Vector3d& target_mm,
                                                  std::uint64_t tissue_seed) {
  if (!parameters_.scene || !robot_.biopsy) {
    return failed("the robot has no needle, or its plant has no tissue");
  }
  plant::SceneParameters scene = *parameters_.scene;
  scene.target_mm = {target_mm.x(), target_mm.y(), target_mm.z()};
  scene.entry_mm = robot_.biopsy->entry_mm;
  plant_.surround(std::make_unique<needle::Scene>(scene, tissue_seed));
  const std::uint32_t scene_tick = state_.system.tick;
  run(ticks_of(settle_s));
  DemoResult<BiopsyRun> prepared = begin_biopsy(target_mm);
  if (!prepared) {
    return failed(prepared.error());
  }
  begin_record();
  const std::uint32_t start_tick = prepared->start_tick;
  begin_task(BiopsyTask{std::make_shared<BiopsyRun>(std::move(*prepared)), {}, start_tick, std::nullopt});
  press_hand(hand_n);
  follow_biopsy(start_tick, scene_tick);
  press_hand(0.0);
  const BiopsyFindings found = modes_.biopsy().findings();
  if (const auto ended = end_task(); !ended) {
    return failed(ended.error() + " " + std::string(found.quantity));
  }
  const plant::NeedleTruth truth = plant_.surroundings()->truth();
  NeedleInsertion done{Eigen::Map<const Eigen::Vector3d>(truth.tip_mm.data()),
                       truth.depth_mm,
                       {truth.punctures_mm.begin(), truth.punctures_mm.end()},
                       {},
                       modes_.biopsy().now().images};
  std::ranges::copy_if(std::span(found.found_mm).first(found.membranes), std::back_inserter(done.found_mm),
                       [](double found_mm) { return found_mm >= 0.0; });
  return done;
}

/** With both forces zeroed, as nothing touches the sensor now. */
DemoResult<BiopsyRun> RobotRig::begin_biopsy(const Eigen::Vector3d& target_mm) {
  const Biopsy& biopsy = *robot_.biopsy;
  const ForceReadings& force = modes_.biopsy().force();
  const auto zeroed = [&](const SensorChannel& channel, std::span<const std::uint32_t> readings) {
    return ForceCalibration::create(channel, biopsy.units_per_newton)
        .and_then([&](const ForceCalibration& made) { return made.zeroed(readings, ZeroingRules{}); });
  };
  const auto position = [&](const char* role) {
    const Axis& axis = *robot_.with_role(role);
    return axis.to_unit(state_.axis[axis.slot].position_counts);
  };
  const BiopsyStart start{state_.system.tick, position("insertion"), position("rotation"), target_mm,
                          biopsy.membranes_mm};
  return zeroed(biopsy.hand, force.recent_hand())
      .and_then([&](const ForceCalibration& hand) {
        return zeroed(biopsy.needle, force.recent_needle()).and_then([&](const ForceCalibration& needle) {
          return make_biopsy_run(biopsy, config_.common.period_us * 1e-6, start, hand, needle);
        });
      })
      .map_error([](const KinematicsError& error) { return error.message(); });
}

/** Until it ends. Hands on each image that was exposed since its start. */
void RobotRig::follow_biopsy(std::uint32_t start_tick, std::uint32_t scene_tick) {
  const double started_s = (start_tick - scene_tick) * static_cast<double>(config_.common.period_us) * 1e-6;
  const std::uint32_t begun = state_.system.tick;
  double shown_s = started_s;
  while (goes_on(begun)) {
    tick();
    const auto& image = plant_.surroundings()->newest_image();
    if (image && image->time_s > shown_s) {
      shown_s = image->time_s;
      modes_.see({task_->id,
                  {image->time_s - started_s, Eigen::Map<const Eigen::Vector3d>(image->tip_mm.data()),
                   Eigen::Map<const Eigen::Vector3d>(image->target_mm.data())}});
    }
  }
}

void RobotRig::begin_task(Work work) {
  const std::uint32_t id = task_ == nullptr ? 1 : task_->id + 1;
  task_ = std::make_shared<const Task>(Task{.work = std::move(work), .author = "study", .id = id});
  modes_.take(task_, state_.system.tick);
  set_pedal(true);
}

TaskStatus RobotRig::status() const { return modes_.tasks().of(task_->kind()); }

bool RobotRig::goes_on(std::uint32_t since_tick) const {
  return is_open(status().phase) && state_.system.tick - since_tick < ticks_of(timeout_s);
}

/** Why it is not done, unless it is. */
DemoResult<void> RobotRig::end_task() {
  const TaskStatus last = status();
  modes_.end(task_->id, TaskReason::cancelled, state_.system.tick);
  set_pedal(false);
  return last.phase == TaskPhase::done ? DemoResult<void>() : failed(ended(robot_, last));
}

void RobotRig::press_hand(double newtons) {
  static_cast<void>(plant_.schedule(plant::command::PressHand{newtons}));
}

void RobotRig::begin_record() {
  record_ = {{}, std::vector<std::vector<AxisSample>>(robot_.axes.size())};
  record_tick_ = state_.system.tick;
}

void RobotRig::note() {
  if (record_.axes.empty() || (state_.system.tick - record_tick_) % ticks_of(record_period_s) != 0) {
    return;
  }
  record_.times_s.push_back((state_.system.tick - record_tick_) *
                            static_cast<double>(config_.common.period_us) * 1e-6);
  for (std::size_t place = 0; place < robot_.axes.size(); ++place) {
    const std::uint32_t slot = robot_.axes[place].slot;
    record_.axes[place].push_back({state_.axis[slot].position_counts,
                                   plant_.station(slot)->axis->speed_counts_per_s(), modes_.setpoint(slot),
                                   outputs_.command[slot].drive});
  }
}

AxisPositions RobotRig::positions() const {
  AxisPositions positions;
  for (const Axis& axis : robot_.axes) {
    positions.push_back(axis.to_unit(state_.axis[axis.slot].position_counts));
  }
  return positions;
}

AxisPositions RobotRig::true_positions() const {
  AxisPositions positions;
  for (const Axis& axis : robot_.axes) {
    positions.push_back(plant_.station(axis.slot)->position_counts() / axis.counts_per_unit);
  }
  return positions;
}

double RobotRig::time_s() const {
  return state_.system.tick * static_cast<double>(config_.common.period_us) * 1e-6;
}

std::uint32_t RobotRig::ticks_of(double seconds) const {
  return static_cast<std::uint32_t>(seconds * 1e6 / config_.common.period_us);
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
  inputs_ = plant::exchange(plant_, outputs_, state_.system.tick);
  ilk_step(&config_, &state_, &inputs_, requests_.data(), static_cast<std::uint32_t>(requests_.size()),
           &outputs_);
  requests_.clear();
  settle_verdicts();
  const KernelRequests requests = modes_.tick(snapshot());
  for (const KernelRequest& request : requests.all()) {
    sent_.push_back({put(sent_form(request, state_.system.consent)), request.origin});
  }
  note();
}

void RobotRig::settle_verdicts() {
  for (std::uint32_t n = 0; n < outputs_.verdict_count; ++n) {
    const ilk_verdict_record_t& record = outputs_.verdict[n];
    const auto found = std::ranges::find(sent_, record.sequence, &Sent::sequence);
    if (found != sent_.end()) {
      modes_.on_verdict(found->origin, record.verdict, record.tick);
      sent_.erase(found);
    }
  }
}

ilk_snapshot_t RobotRig::snapshot() const {
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

}  // namespace interlock
