#include "service/run_recorder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "proposals/profile.hpp"
#include "proposals/proposal_json.hpp"
#include "system/launch.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr std::size_t recent_buckets = 4;
constexpr std::chrono::seconds pause_after_failure{1};

/** When its axes began to move, by the control thread; by the newest view where that is known no more. */
std::uint32_t begun_tick_of(const ControlView& view, std::uint32_t id) {
  const auto status = std::ranges::find_if(view.tasks, [&](const TaskStatus& each) {
    return each.task == id && each.phase == TaskPhase::executing;
  });
  return status == view.tasks.end() ? view.snapshot.state.system.tick : status->tick;
}

json position_in(const ControlView& view, std::uint32_t slot) {
  const ilk_axis_t& axis = view.snapshot.state.axis[slot];
  return view.attached && axis.card_valid != 0 ? json(axis.position_counts) : json();
}

json target_of(const Proposal& proposal, std::uint32_t slot) {
  if (const MoveTask* move = proposal.work<MoveTask>()) {
    return move->jog ? json() : json(move->target_counts);
  }
  const auto end = std::ranges::find(proposal.ends, slot, &AxisCounts::slot);
  return end == proposal.ends.end() ? json() : json(end->counts);
}

template <typename Value>
void keep_every_other(std::vector<Value>& values) {
  std::size_t kept = 0;
  for (std::size_t place = 0; place < values.size(); place += 2) {
    values[kept++] = values[place];
  }
  values.resize(kept);
}

json listed_counts(const std::vector<std::optional<std::int32_t>>& counts) {
  json list = json::array();
  for (const auto& each : counts) {
    list.push_back(each ? json(*each) : json());
  }
  return list;
}

/** What a run keeps of the plan in the profile: positions to a count, times to a microsecond. */
json kept_plan(const Profile& profile) {
  json times = json::array();
  for (const double time_s : profile.times_s) {
    times.push_back(std::round(time_s * 1e6) / 1e6);
  }
  json axes = json::array();
  for (const AxisProfile& axis : profile.axes) {
    json positions = json::array();
    for (const double position : axis.positions) {
      positions.push_back(std::llround(position));
    }
    axes.push_back({{"slot", axis.slot}, {"positions_counts", std::move(positions)}});
  }
  return {{"basis", basis_name(profile.basis)},
          {"why", profile.why.empty() ? json() : json(profile.why)},
          {"times_s", std::move(times)},
          {"axes", std::move(axes)}};
}

}  // namespace

void RunRecorder::follow(const Proposal& proposal) {
  Recording* recording = find(proposal.id);
  const bool moved = proposal.state == ProposalState::executing || proposal.state == ProposalState::done;
  if (recording == nullptr && moved) {
    begin(proposal);
    recording = find(proposal.id);
  }
  if (recording == nullptr || recording->ended) {
    return;
  }
  recording->run.value["detail"] = proposal.detail;
  if (!is_open(proposal.state)) {
    end(*recording, proposal);
  }
}

void RunRecorder::begin(const Proposal& proposal) {
  for (Recording& each : recordings_) {
    const bool shares = std::ranges::any_of(each.axes, [&](const AxisRecord& axis) {
      return std::ranges::find(proposal.slots, axis.slot) != proposal.slots.end();
    });
    if (each.ended && !each.settled && shares) {
      settle(each);
    }
  }
  const json shown = to_json(proposal);
  const ControlView& view = context_.control.current();
  Recording made{.run = {.number = proposal.id,
                         .case_number = proposal.task->case_number,
                         .kind = shown["kind"],
                         .axes = proposal.axes,
                         .outcome = run_goes_on,
                         .begun = context_.clock(),
                         .note = {},
                         .value = {{"mode", shown.value("mode", "manual")},
                                   {"author", shown["author"]},
                                   {"source", shown["source"]},
                                   {"aim", shown["aim"]},
                                   {"verdict", nullptr},
                                   {"robot", context_.robot.name},
                                   {"configuration", context_.robot.revision},
                                   {"ended", nullptr},
                                   {"ended_tick", nullptr},
                                   {"duration_s", nullptr},
                                   {"axes", json::array()}}},
                 .begun_tick = begun_tick_of(view, proposal.id),
                 .has_timed_plan = proposal.work<PathTask>() != nullptr,
                 .history_run = std::nullopt,
                 .plan = kept_plan(no_profile("The run ended before its plan was known.")),
                 .next = context_.steady_clock() + keeping};
  made.run.value["begun_tick"] = made.begun_tick;
  for (const std::uint32_t slot : proposal.slots) {
    const Axis& axis = *context_.robot.at_slot(slot);
    made.axes.push_back({.slot = slot, .commanded = {}, .actual = {}});
    made.run.value["axes"].push_back({{"slot", slot},
                                      {"axis", axis.name},
                                      {"title", axis.title},
                                      {"unit", unit_name(axis.unit)},
                                      {"counts_per_unit", axis.counts_per_unit},
                                      {"begin_counts", position_in(view, slot)},
                                      {"target_counts", target_of(proposal, slot)},
                                      {"end_counts", nullptr},
                                      {"largest_error_counts", nullptr},
                                      {"rms_error_counts", nullptr}});
  }
  for (const TickBucket& bucket : recent_) {
    add(made, bucket);
  }
  recordings_.push_back(std::move(made));
  launch(context_.executor, find_plan(proposal));
}

boost::asio::awaitable<void> RunRecorder::find_plan(Proposal proposal) {
  auto work = [proposal, robot = &context_.robot, config = &context_.config] {
    return kept_plan(profile_of(*robot, *config, proposal));
  };
  auto plan = co_await context_.work.run(std::move(work));
  if (Recording* recording = find(proposal.id)) {
    recording->plan = plan ? std::move(*plan) : kept_plan(no_profile(plan.error().detail));
    recording->unsaved = recording->unsaved || recording->settled;
  }
}

/** Where the axes are now, as far as that is known. */
void RunRecorder::note_ends(Recording& recording) const {
  for (json& axis : recording.run.value["axes"]) {
    if (json now = position_in(context_.control.current(), axis["slot"]); !now.is_null()) {
      axis["end_counts"] = std::move(now);
    }
  }
}

void RunRecorder::end(Recording& recording, const Proposal& proposal) {
  const ControlView& view = context_.control.current();
  const UtcTime now = context_.clock();
  const std::uint32_t tick = view.snapshot.state.system.tick;
  // Ticks of another kernel, or of none, are no time.
  const bool same_kernel = view.attached && tick >= recording.begun_tick;
  json& value = recording.run.value;
  recording.run.outcome = state_name(proposal.state);
  value["verdict"] = proposal.verdict ? json(*proposal.verdict) : json();
  value["ended"] = iso_8601(now);
  value["ended_tick"] = same_kernel ? json(tick) : json();
  value["duration_s"] = same_kernel ? (tick - recording.begun_tick) * context_.config.common.period_us * 1e-6
                                    : std::chrono::duration<double>(now - recording.run.begun).count();
  note_ends(recording);
  recording.ended = true;
  recording.unsaved = true;
  recording.next = context_.steady_clock() + settling;
}

void RunRecorder::settle(Recording& recording) {
  note_ends(recording);
  recording.settled = true;
  recording.unsaved = true;
}

void RunRecorder::add(const TickBucket& bucket) {
  recent_.push_back(bucket);
  if (recent_.size() > recent_buckets) {
    recent_.pop_front();
  }
  for (Recording& each : recordings_) {
    if (!each.settled) {
      add(each, bucket);
    }
  }
}

void RunRecorder::add(Recording& recording, const TickBucket& bucket) {
  const bool is_of_it =
      bucket.last_tick >= recording.begun_tick && recording.history_run.value_or(bucket.run) == bucket.run;
  if (!is_of_it) {
    return;
  }
  recording.history_run = bucket.run;
  for (AxisRecord& axis : recording.axes) {
    const AxisExtremes& seen = bucket.axis[axis.slot];
    axis.error_squares += seen.error_squares;
    axis.error_ticks += seen.error_ticks;
    if (seen.error_counts.known()) {
      axis.largest_error = std::max({axis.largest_error, std::abs(std::int64_t{seen.error_counts.least()}),
                                     std::abs(std::int64_t{seen.error_counts.greatest()})});
    }
  }
  if (++recording.skipped < recording.stride) {
    return;
  }
  recording.skipped = 0;
  recording.ticks.push_back(bucket.last_tick - recording.begun_tick);
  for (AxisRecord& axis : recording.axes) {
    axis.commanded.push_back(bucket.axis[axis.slot].last_setpoint_counts);
    axis.actual.push_back(bucket.axis[axis.slot].last_position_counts);
  }
  if (recording.ticks.size() == most_samples) {
    thin(recording);
  }
}

void RunRecorder::thin(Recording& recording) {
  keep_every_other(recording.ticks);
  for (AxisRecord& axis : recording.axes) {
    keep_every_other(axis.commanded);
    keep_every_other(axis.actual);
  }
  recording.stride *= 2;
}

json RunRecorder::samples_of(const Recording& recording) {
  json axes = json::array();
  for (const AxisRecord& axis : recording.axes) {
    axes.push_back({{"slot", axis.slot},
                    {"commanded_counts", listed_counts(axis.commanded)},
                    {"actual_counts", listed_counts(axis.actual)}});
  }
  return {{"ticks", recording.ticks},
          {"buckets_of_sample", recording.stride},
          {"axes", std::move(axes)},
          {"plan", recording.plan}};
}

KeptRun RunRecorder::kept_of(const Recording& recording) {
  KeptRun run = recording.run;
  for (std::size_t place = 0; place < recording.axes.size(); ++place) {
    const AxisRecord& axis = recording.axes[place];
    if (recording.has_timed_plan && axis.error_ticks != 0) {
      json& figures = run.value["axes"][place];
      figures["largest_error_counts"] = axis.largest_error;
      figures["rms_error_counts"] = std::sqrt(axis.error_squares / static_cast<double>(axis.error_ticks));
    }
  }
  return run;
}

void RunRecorder::check() {
  const SteadyTime now = context_.steady_clock();
  for (Recording& each : recordings_) {
    if (each.ended && !each.settled && now >= each.next) {
      settle(each);
    } else if (!each.ended && now >= each.next) {
      each.unsaved = true;
      each.next = now + keeping;
    }
  }
  if (!saving_) {
    std::erase_if(recordings_, [](const Recording& each) { return each.settled && !each.unsaved; });
  }
  while (recordings_.size() > most_waiting && recordings_.front().settled) {
    spdlog::error("run {} is lost: the store does not take it", recordings_.front().run.number);
    recordings_.pop_front();
  }
  const bool due = std::ranges::any_of(recordings_, &Recording::unsaved);
  if (due && now >= retry_ && !std::exchange(saving_, true)) {
    launch(context_.executor, save());
  }
}

/** One after the other: a store that fails is not asked again before a pause. */
boost::asio::awaitable<void> RunRecorder::save() {
  for (;;) {
    const auto due = std::ranges::find_if(recordings_, &Recording::unsaved);
    if (due == recordings_.end()) {
      break;
    }
    due->unsaved = false;
    const std::int64_t number = due->run.number;
    auto work = [recording = *due, now = context_.clock()](Store& store) {
      return store.transact([&](Transaction& transaction) -> Stored<void> {
        Runs runs(transaction);
        KeptRun run = kept_of(recording);
        run.value["kept"] = iso_8601(now);
        runs.keep(run, samples_of(recording));
        runs.prune(now);
        return {};
      });
    };
    const auto kept = co_await context_.store.run(std::move(work));
    if (!kept) {
      if (Recording* recording = find(number)) {
        recording->unsaved = true;
      }
      retry_ = context_.steady_clock() + pause_after_failure;
      break;
    }
  }
  saving_ = false;
}

RunRecorder::Recording* RunRecorder::find(std::int64_t number) {
  const auto found =
      std::ranges::find_if(recordings_, [&](const Recording& each) { return each.run.number == number; });
  return found == recordings_.end() ? nullptr : &*found;
}

}  // namespace interlock
