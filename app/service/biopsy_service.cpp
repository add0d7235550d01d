#include "service/biopsy_service.hpp"

#include <algorithm>
#include <utility>

#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;

std::optional<ForceCalibration> calibration_of(const SensorChannel& channel, double units_per_newton) {
  const auto made = ForceCalibration::create(channel, units_per_newton);
  return made ? std::optional(*made) : std::nullopt;
}

json force_json(const std::optional<ForceCalibration>& calibration, std::uint32_t counts, bool known) {
  json force{{"raw_counts", nullptr}, {"force_n", nullptr}, {"zero_counts", nullptr}};
  if (!calibration) {
    return force;
  }
  force["zero_counts"] = calibration->zero_counts();
  if (known) {
    force["raw_counts"] = counts;
    const auto force_n = calibration->force_n(counts);
    force["force_n"] = force_n ? json(*force_n) : json(nullptr);
  }
  return force;
}

json now_json(const ControlView& view) {
  const BiopsyNow& now = view.biopsy_now;
  return {{"depth_mm", now.depth_mm},
          {"speed_mm_s", now.speed_mm_s},
          {"left_mm", now.left_mm},
          {"waits_for_hand", now.waits_for_hand},
          {"armed", now.armed},
          {"rough", now.rough},
          {"cue", now.cue},
          {"wanted_rotation_rad", now.desired_rotation_rad},
          {"alpha", now.alpha},
          {"curvature_per_mm", now.curvature_per_mm},
          {"expected_miss_mm", now.expected_miss_mm},
          {"reachable", now.reachable},
          {"tip_sd_mm", now.tip_sd_mm},
          {"images_disagree", now.images_disagree},
          {"images", now.images},
          {"images_refused", now.images_refused}};
}

Problem not_zeroed(const std::string& force, const std::string& reason) {
  return {.status = Status::conflict,
          .code = "ZEROING",
          .detail = "The force of the " + force + " was not zeroed: " + reason,
          .expected = "a sensor that nothing touches",
          .next_step = "Let go of the sensor and of the needle, then zero again."};
}

}  // namespace

BiopsyService::BiopsyService(const Robot& robot) : robot_(robot) {
  if (robot.biopsy) {
    hand_ = calibration_of(robot.biopsy->hand, robot.biopsy->units_per_newton);
    needle_ = calibration_of(robot.biopsy->needle, robot.biopsy->units_per_newton);
    set({robot.biopsy->membranes_mm, 0});
  }
}

tl::expected<Task, Problem> BiopsyService::draft(const std::array<double, 3>& target_mm,
                                                 const ControlView& view, const std::string& author) const {
  if (!hand_ || !needle_) {
    return fail(not_found("needle for a biopsy", "a robot with a [biopsy] table in its file"));
  }
  const auto position = [&](const char* role) {
    const Axis& axis = *robot_.with_role(role);
    return axis.to_unit(view.snapshot.state.axis[axis.slot].position_counts);
  };
  const BiopsyStart start{view.snapshot.state.system.tick,
                          position("insertion"),
                          position("rotation"),
                          {target_mm[0], target_mm[1], target_mm[2]},
                          std::span(membranes_.depths_mm).subspan(membranes_.next)};
  auto run = make_biopsy_run(*robot_.biopsy, robot_.period_us * 1e-6, start, *hand_, *needle_);
  if (!run) {
    return fail(invalid("target_mm", run.error().message(), "a target ahead of the needle"));
  }
  return Task{
      .work = BiopsyTask{std::make_shared<BiopsyRun>(std::move(*run)), target_mm, start.tick, std::nullopt},
      .author = author,
      .mode = RobotMode{"cooperative_biopsy"},
      .rests_on = standing(robot_, view)};
}

void BiopsyService::begin(std::uint32_t proposal) {
  proposal_ = proposal;
  first_ = membranes_.next;
}

void BiopsyService::follow(const ControlView& view) {
  if (proposal_ == 0 || view.biopsy.task != proposal_) {
    return;
  }
  for (std::size_t each = 0; each < view.biopsy.membranes && first_ + each < passed_.size(); ++each) {
    const double found_mm = view.biopsy.found_mm[each];
    passed_[first_ + each] = {true, found_mm < 0.0 ? std::nullopt : std::optional(found_mm)};
    membranes_.next = std::max(membranes_.next, first_ + each + 1);
  }
}

void BiopsyService::set(Membranes membranes) {
  membranes_ = std::move(membranes);
  passed_.assign(membranes_.depths_mm.size(), Passed{});
  for (std::size_t each = 0; each < membranes_.next; ++each) {
    passed_[each].passed = true;
  }
  proposal_ = 0;
}

void BiopsyService::reset() { set({membranes_.depths_mm, 0}); }

tl::expected<void, Problem> BiopsyService::zero(const ControlView& view) {
  if (!hand_ || !needle_) {
    return fail(not_found("force sensor of a needle", "a robot with a [biopsy] table in its file"));
  }
  const ZeroingRules rules;
  const auto hand = hand_->zeroed(view.force.recent_hand(), rules);
  if (!hand) {
    return fail(not_zeroed("hand", hand.error().message()));
  }
  const auto needle = needle_->zeroed(view.force.recent_needle(), rules);
  if (!needle) {
    return fail(not_zeroed("needle", needle.error().message()));
  }
  hand_ = *hand;
  needle_ = *needle;
  return {};
}

std::optional<double> BiopsyService::needle_force_n(const ControlView& view) const {
  constexpr std::uint32_t oldest_us = 20000;
  const bool is_fresh =
      view.attached && view.force.age_ticks(view.snapshot.state.system.tick) <= oldest_us / robot_.period_us;
  if (!needle_ || !is_fresh) {
    return std::nullopt;
  }
  const auto force_n = needle_->force_n(view.force.needle);
  return force_n ? std::optional(*force_n) : std::nullopt;
}

json BiopsyService::membranes_json() const {
  json membranes = json::array();
  for (std::size_t each = 0; each < membranes_.depths_mm.size(); ++each) {
    const Passed& passed = passed_[each];
    const bool next = each == membranes_.next;
    membranes.push_back({{"depth_mm", membranes_.depths_mm[each]},
                         {"state", next            ? "next"
                                   : passed.passed ? "passed"
                                                   : "expected"},
                         {"found_mm", passed.found_mm ? json(*passed.found_mm) : json(nullptr)}});
  }
  return membranes;
}

json BiopsyService::to_json(const ControlView& view, bool open) const {
  const bool known = view.attached && view.force.count != 0;
  const double ticks = view.force.age_ticks(view.snapshot.state.system.tick);
  return {{"open", open},
          {"hand", force_json(hand_, view.force.hand, known)},
          {"needle", force_json(needle_, view.force.needle, known)},
          {"force_age_ms", known ? json(ticks * robot_.period_us * 1e-3) : json(nullptr)},
          {"membranes", membranes_json()},
          {"next", membranes_.next},
          {"left", membranes_.depths_mm.size() - membranes_.next},
          {"now", open ? now_json(view) : json(nullptr)}};
}

}  // namespace interlock
