#include "robot_rig.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <memory>
#include <span>

#include "needle/scene.hpp"

namespace interlock {
namespace {

/** Longer than debouncing, bounce and settling take. */
constexpr double settle_s = 0.2;
/** Longer than homing of either robot takes, or the longest way. */
constexpr double timeout_s = 1800.0;
/** A hand in the middle of those of models/needle. */
constexpr double hand_n = 4.5;
constexpr double record_period_s = 0.005;

tl::unexpected<std::string> failed(std::string what) { return tl::unexpected(std::move(what)); }

std::string ended(const Robot& robot, const TaskStatus& status) {
  if (is_open(status.phase)) {
    return "the motion waits still, after half an hour of simulated time: of a biopsy, images that "
           "contradict what "
           "is believed, or a closed gate";
  }
  const Axis* axis = robot.at_slot(status.slot);
  return (axis == nullptr ? "the robot" : axis->name) + ": the task ended in phase " +
         std::to_string(static_cast<int>(status.phase)) + " for reason " +
         std::to_string(static_cast<int>(status.reason)) + ", code " + std::to_string(status.code);
}

}  // namespace

RobotRig::RobotRig(const Robot& robot, const plant::Parameters& parameters, std::uint64_t seed)
    : robot_(robot), parameters_(parameters), loop_(seed, 0, robot, parameters) {
  loop_.watch([this] { note(); });
}

DemoResult<void> RobotRig::make_ready() {
  try {
    for (const Axis& axis : robot_.axes) {
      if (axis.limit == ILK_LIMIT_NONE) {
        loop_.request(ILK_REQUEST_SET_HOME, axis.slot);
      }
      loop_.request(ILK_REQUEST_ENABLE, axis.slot);
    }
  } catch (const std::exception& error) {
    return failed(error.what());
  }
  return home();
}

/** Presses again as often as a step asks for it. */
DemoResult<void> RobotRig::home() {
  begin_task(HomeTask{0, static_cast<std::uint32_t>(robot_.home_steps.size()), {}});
  const std::uint32_t begun = tick();
  while (goes_on(begun)) {
    loop_.tick();
    if (status().reason == TaskReason::press_again) {
      loop_.pedal(false);
      loop_.pedal(true);
    }
  }
  return end_task();
}

DemoResult<void> RobotRig::carry_out(const PathProgram& program) {
  begin_record();
  begin_task(PathTask{std::make_shared<const PathProgram>(program)});
  const std::uint32_t begun = tick();
  while (goes_on(begun)) {
    loop_.tick();
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
  loop_.plant().surround(std::make_unique<needle::Scene>(scene, tissue_seed));
  const std::uint32_t scene_tick = tick();
  loop_.run(ticks_of(settle_s));
  DemoResult<BiopsyRun> prepared = begin_biopsy(target_mm);
  if (!prepared) {
    return failed(prepared.error());
  }
  begin_record();
  const std::uint32_t start_tick = prepared->start_tick;
  begin_task(BiopsyTask{std::make_shared<BiopsyRun>(std::move(*prepared)), {}, start_tick, std::nullopt});
  loop_.happen(plant::command::PressHand{hand_n});
  follow_biopsy(start_tick, scene_tick);
  loop_.happen(plant::command::PressHand{0.0});
  const BiopsyFindings found = loop_.biopsy().findings();
  if (const auto ended = end_task(); !ended) {
    return failed(ended.error() + " " + std::string(found.quantity));
  }
  const plant::NeedleTruth truth = loop_.plant().surroundings()->truth();
  NeedleInsertion done{Eigen::Map<const Eigen::Vector3d>(truth.tip_mm.data()),
                       truth.depth_mm,
                       {truth.punctures_mm.begin(), truth.punctures_mm.end()},
                       {},
                       loop_.biopsy().now().images};
  std::ranges::copy_if(std::span(found.found_mm).first(found.membranes), std::back_inserter(done.found_mm),
                       [](double found_mm) { return found_mm >= 0.0; });
  return done;
}

/** With both forces zeroed, as nothing touches the sensor now. */
DemoResult<BiopsyRun> RobotRig::begin_biopsy(const Eigen::Vector3d& target_mm) {
  const Biopsy& biopsy = *robot_.biopsy;
  const ForceReadings& force = loop_.biopsy().force();
  const auto zeroed = [&](const SensorChannel& channel, std::span<const std::uint32_t> readings) {
    return ForceCalibration::create(channel, biopsy.units_per_newton)
        .and_then([&](const ForceCalibration& made) { return made.zeroed(readings, ZeroingRules{}); });
  };
  const auto position = [&](const char* role) {
    const Axis& axis = *robot_.with_role(role);
    return axis.to_unit(loop_.state().axis[axis.slot].position_counts);
  };
  const BiopsyStart start{tick(), position("insertion"), position("rotation"), target_mm,
                          biopsy.membranes_mm};
  return zeroed(biopsy.hand, force.recent_hand())
      .and_then([&](const ForceCalibration& hand) {
        return zeroed(biopsy.needle, force.recent_needle()).and_then([&](const ForceCalibration& needle) {
          return make_biopsy_run(biopsy, loop_.config().common.period_us * 1e-6, start, hand, needle);
        });
      })
      .map_error([](const KinematicsError& error) { return error.message(); });
}

/** Until it ends. Hands on each image that was exposed since its start. */
void RobotRig::follow_biopsy(std::uint32_t start_tick, std::uint32_t scene_tick) {
  const double started_s = (start_tick - scene_tick) * tick_s();
  const std::uint32_t begun = tick();
  double shown_s = started_s;
  while (goes_on(begun)) {
    loop_.tick();
    const auto& image = loop_.plant().surroundings()->newest_image();
    if (image && image->time_s > shown_s) {
      shown_s = image->time_s;
      loop_.show({task_,
                  {image->time_s - started_s, Eigen::Map<const Eigen::Vector3d>(image->tip_mm.data()),
                   Eigen::Map<const Eigen::Vector3d>(image->target_mm.data())}});
    }
  }
}

void RobotRig::begin_task(Work work) {
  kind_ = &work.type();
  loop_.give(++task_, std::move(work));
  loop_.pedal(true);
}

TaskStatus RobotRig::status() const { return loop_.status(*kind_); }

bool RobotRig::goes_on(std::uint32_t since_tick) const {
  return is_open(status().phase) && tick() - since_tick < ticks_of(timeout_s);
}

/** Why it is not done, unless it is. */
DemoResult<void> RobotRig::end_task() {
  const TaskStatus last = status();
  loop_.cancel(task_);
  loop_.pedal(false);
  return last.phase == TaskPhase::done ? DemoResult<void>() : failed(ended(robot_, last));
}

void RobotRig::begin_record() {
  record_ = {{}, std::vector<std::vector<AxisSample>>(robot_.axes.size())};
  record_tick_ = tick();
}

void RobotRig::note() {
  if (record_.axes.empty() || (tick() - record_tick_) % ticks_of(record_period_s) != 0) {
    return;
  }
  record_.times_s.push_back((tick() - record_tick_) * tick_s());
  for (std::size_t place = 0; place < robot_.axes.size(); ++place) {
    const std::uint32_t slot = robot_.axes[place].slot;
    record_.axes[place].push_back({loop_.state().axis[slot].position_counts,
                                   loop_.plant().station(slot)->axis->speed_counts_per_s(),
                                   loop_.setpoint(slot), loop_.outputs().command[slot].drive});
  }
}

AxisPositions RobotRig::positions() const {
  AxisPositions positions;
  for (const Axis& axis : robot_.axes) {
    positions.push_back(axis.to_unit(loop_.state().axis[axis.slot].position_counts));
  }
  return positions;
}

double RobotRig::homing_counts() const {
  double farthest = 0.0;
  for (const Axis& axis : robot_.axes) {
    if (axis.homing) {
      const double read = loop_.state().axis[axis.slot].position_counts;
      farthest = std::max(farthest, std::abs(std::floor(loop_.true_position(axis.slot)) - read));
    }
  }
  return farthest;
}

AxisPositions RobotRig::true_positions() const {
  AxisPositions positions;
  for (const Axis& axis : robot_.axes) {
    positions.push_back(loop_.true_tool(axis.slot) / axis.counts_per_unit);
  }
  return positions;
}

double RobotRig::tick_s() const { return loop_.config().common.period_us * 1e-6; }

std::uint32_t RobotRig::ticks_of(double seconds) const {
  return static_cast<std::uint32_t>(seconds * 1e6 / loop_.config().common.period_us);
}

}  // namespace interlock
